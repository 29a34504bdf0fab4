#pragma once

#include "foam/block_pcg.h"
#include "foam/block_system.h"
#include "foam/direct_solve.h"
#include "foam/foam_params.h"

namespace spume::foam {

/// What a solve did. `residual` is relative to that of the first guess.
struct SolveReport {
  int iterations = 0;
  double residual = 0;
  bool converged = false;
  bool fellBack = false;  ///< the iteration stalled and the direct solver took over
};

/// Solves the implicit step by conjugate gradients with a preconditioner of choice, or directly. Keeps its
/// memory between calls. The result does not depend on the number of threads.
class ImplicitSolve {
 public:
  explicit ImplicitSolve(LinearSolver solver = LinearSolver::pcgIncompleteCholesky) : solver_(solver) {}

  /// What rounding alone leaves of the residual: a pinned bubble's block is a million times stiffer than the
  /// rest.
  static double roundOff(const BlockSystem& a, const Vectors3& x);
  /// |b - A x| [kg m/s].
  double residual(const BlockSystem& a, const Vectors3& b, const Vectors3& x);

  /// Solves A x = b from the given x until |b - A x| <= goal [kg m/s]. An iteration that does not get there
  /// within `maxIterations` is finished by the direct solver, where its factor fits into memory. A result
  /// that did not converge is still the best one found.
  SolveReport solve(const BlockSystem& a, const Vectors3& b, double goal, int maxIterations, Vectors3& x);
  /// The same when only `a.own` has changed since the last call of either: what depends on couplings is kept.
  SolveReport solveAgain(const BlockSystem& a, const Vectors3& b, double goal, int maxIterations,
                         Vectors3& x);
  /// Corrects x by a rigid motion of everything, after which the residuals add up to nothing but round-off:
  /// couplings then leave total momentum as it is. Not for between solves: what it takes from all it adds to
  /// the few rows that resist most, and they would have to be solved again.
  void balance(const BlockSystem& a, const Vectors3& b, Vectors3& x);
  /// b - A x of each row as the last of these left it [kg m/s].
  const Vectors3& left() const { return residual_; }

 private:
  int iterate(const BlockSystem& a, const Vectors3& b, double goal, int maxIterations, double& norm,
              Vectors3& x);
  bool solveDirectly(const BlockSystem& a, const Vectors3& b, double goal, Vectors3& x);

  LinearSolver solver_;
  bool couplingsKnown_ = false;  ///< swept_ holds those of the system
  SweptSystem swept_;
  IncompleteCholesky cholesky_;
  BlockPcg pcg_;
  DirectSolve direct_;
  Vectors3 residual_;
};

}  // namespace spume::foam
