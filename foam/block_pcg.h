#pragma once

#include "foam/incomplete_cholesky.h"
#include "foam/swept_system.h"

namespace spume::foam {

/// Conjugate gradients on a SweptSystem with its incomplete Cholesky factor as preconditioner, arranged so
/// that an iteration costs one product: with C = D + L and A = C + C^T + (diag A - 2 D) + E, where E couples
/// blocks, each product with C^-1 A C^-T is a sweep back and a sweep forth [Eisenstat 1981]. Blocks are swept
/// in parallel; sums are taken block by block, so the result does not depend on the number of threads.
class BlockPcg {
 public:
  /// Adds to `x` (rows as in the BlockSystem) a solution of A e = b, until |b - A e| <= goal [kg m/s] or
  /// `maxIterations`. Returns the iterations made.
  int improve(const SweptSystem& a, const IncompleteCholesky& factor, const Vectors3& b, double goal,
              int maxIterations, Vectors3& x);

 private:
  double start(const SweptSystem& a, const IncompleteCholesky& factor, const Vectors3& b);
  void sweepBack(const SweptSystem& a, const IncompleteCholesky& factor, double momentum);
  double sweepForth(const SweptSystem& a, const IncompleteCholesky& factor);
  double advance(const SweptSystem& a, const IncompleteCholesky& factor, double step);
  double residual(const SweptSystem& a, const IncompleteCholesky& factor);

  /// Three numbers and a 0, a register each.
  using Vectors4 = std::vector<Eigen::Vector4d>;

  Vectors4 sum_;                 ///< e so far
  Vectors4 residual_;            ///< C^-1 of the residual
  Vectors4 direction_;           ///< C^T of the search direction
  Vectors4 step_;                ///< the search direction
  Vectors4 image_;               ///< C^-1 A of the search direction
  std::vector<double> partial_;  ///< sums by block
};

}  // namespace spume::foam
