#pragma once

#include <memory>
#include <string>

#include "foam/block_system.h"

namespace spume::foam {

/// Sparse Cholesky factorisation of a BlockSystem (CHOLMOD): the reference for the iterative solvers, and
/// what takes over when they stall. Time and memory grow faster than linearly in a foam that is thick in all
/// directions.
class DirectSolve {
 public:
  DirectSolve();
  ~DirectSolve();
  DirectSolve(DirectSolve&&) noexcept;
  DirectSolve& operator=(DirectSolve&&) noexcept;

  /// Factorises `a`; the fill-reducing order is kept while the graph of couplings stays the same. False if
  /// the matrix is not positive definite or the factor would exceed kLargestFactor.
  bool factor(const BlockSystem& a);
  /// Adds to `x` the solution of A e = b with the last factor.
  void improve(const Vectors3& b, Vectors3& x);

  /// Most entries of a factor: 4 GB of doubles. That of 100000 bubbles of a thick, dense foam still fits.
  static constexpr double kLargestFactor = 5e8;

 private:
  struct Internals;
  std::unique_ptr<Internals> internals_;
};

}  // namespace spume::foam
