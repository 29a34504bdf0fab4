#pragma once

#include "foam/incomplete_cholesky.h"
#include "foam/swept_system.h"

namespace spume::foam {

/// Conjugate gradients on a SweptSystem with its incomplete Cholesky factor as preconditioner, arranged so
/// that an iteration costs one product: with C = D + L and A = C + C^T + (diag A - 2 D) + E, where E couples
/// blocks, each product with C^-1 A C^-T is a sweep back and a sweep forth [Eisenstat 1981]. Blocks are swept
/// in parallel; sums are taken group by group, so the result does not depend on the number of threads.
class BlockPcg {
 public:
  /// Adds to `x` (rows as in the BlockSystem) a solution of A e = b, until |b - A e| <= goal [kg m/s] or
  /// `maxIterations`. Returns the iterations made.
  int improve(const SweptSystem& a, const IncompleteCholesky& factor, const Vectors3& b, double goal,
              int maxIterations, Vectors3& x);

 private:
  double start(const SweptSystem& a, const IncompleteCholesky& factor, const Vectors3& b);
  void searchBack(const SweptSystem& a, const IncompleteCholesky& factor, double momentum);
  double searchForth(const SweptSystem& a, const IncompleteCholesky& factor);
  double advance(const SweptSystem& a, const IncompleteCholesky& factor, double step);
  double residual(const SweptSystem& a, const IncompleteCholesky& factor);

  /// Where the list of known vectors holds what rows behind a row have become.
  std::size_t behind(std::size_t k) const { return sum_.size() + 1 + k; }
  const Eigen::Vector4d& stepOf(std::size_t k) const { return known_[k]; }

  /// Three numbers and a 0, a register each.
  using Vectors4 = std::vector<Eigen::Vector4d>;

  Vectors4 sum_;        ///< e so far
  Vectors4 residual_;   ///< C^-1 of the residual
  Vectors4 direction_;  ///< C^T of the search direction
  /// What couplings act on, by SweptSystem::other: the search direction, a 0, and minus its image C^-1 A.
  Vectors4 known_;
  std::vector<double> partial_;  ///< sums by group
};

}  // namespace spume::foam
