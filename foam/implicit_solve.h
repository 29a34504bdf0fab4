#pragma once

#include "foam/block_system.h"

namespace spume::foam {

/// What a solve did. `residual` is relative to that of the first guess.
struct SolveReport {
  int iterations = 0;
  double residual = 0;
  bool converged = false;
};

/// Conjugate gradients with the inverted 3 x 3 diagonal blocks as preconditioner. Keeps its vectors between
/// calls. The result does not depend on the number of threads.
class ImplicitSolve {
 public:
  /// |b - A x| [kg m/s].
  double residual(const BlockSystem& a, const Vectors3& b, const Vectors3& x);

  /// Solves A x = b from the given x until |b - A x| <= goal [kg m/s]. Ends with a correction by a rigid
  /// motion of everything, so that total momentum changes by the outer forces alone to round-off. A result
  /// that did not converge is still the best one found.
  SolveReport solve(const BlockSystem& a, const Vectors3& b, double goal, int maxIterations, Vectors3& x);

 private:
  void prepare(const BlockSystem& a);
  void shiftRigidly(const BlockSystem& a, Vectors3& x);

  std::vector<Eigen::Matrix3d> inverse_;
  Vectors3 residual_, direction_, image_, preconditioned_;
};

}  // namespace spume::foam
