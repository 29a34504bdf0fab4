#pragma once

#include <cstdint>
#include <vector>

#include "foam/block_pcg.h"
#include "foam/block_system.h"
#include "foam/coarse_correction.h"
#include "foam/direct_solve.h"
#include "foam/foam_params.h"
#include "foam/solve_watch.h"

namespace spume::foam {

/// What a solve did. `residual` is relative to that of the first guess.
struct SolveReport {
  int iterations = 0;
  double residual = 0;
  bool converged = false;
  bool stopped = false;   ///< by the watch, before that
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
  /// Takes on the system A x = b with a first guess. Returns |b - A x| [kg m/s].
  double begin(const BlockSystem& a, const Vectors3& b, const Vectors3& x);
  /// The same where x is zero but for those of `rows`.
  double begin(const BlockSystem& a, const Vectors3& b, const Vectors3& x,
               const std::vector<std::int32_t>& rows);
  /// The same when only own blocks, b and x of `rows` have changed since the system was last looked at: all
  /// that does not depend on these is kept.
  double follow(const BlockSystem& a, const Vectors3& b, const Vectors3& x,
                const std::vector<std::int32_t>& rows);
  /// Solves until |b - A x| <= goal [kg m/s], from the x and the system that begin() or, after that, solve()
  /// and follow() have last seen. An iteration that does not get there within `maxIterations` is finished by
  /// the direct solver, where its factor fits into memory. A result that did not converge is still the best
  /// one found. The `watch` may end an iteration before.
  SolveReport solve(const BlockSystem& a, const Vectors3& b, double goal, int maxIterations, Vectors3& x,
                    SolveWatch& watch);
  SolveReport solve(const BlockSystem& a, const Vectors3& b, double goal, int maxIterations, Vectors3& x);
  /// Corrects x by a rigid motion of everything, after which the residuals add up to nothing but round-off:
  /// couplings then leave total momentum as it is. Ends work on the system, of which x is what has last been
  /// seen: what it takes from all it adds to the few rows that resist most, and they would have to be solved
  /// again.
  void balance(const BlockSystem& a, Vectors3& x) const;
  /// b - A x of each row as begin(), follow() or solve() left it [kg m/s]; where a watch has ended it, off
  /// by as much as that allows.
  const Vectors3& left() const { return residual_; }

 private:
  void findResidual(const BlockSystem& a, const Vectors3& b, const Vectors3& x);
  void findResidualAround(const BlockSystem& a, const Vectors3& b, const Vectors3& x,
                          const std::vector<std::int32_t>& rows);
  void iterate(const BlockSystem& a, const Vectors3& b, double goal, int maxIterations, SolveWatch& watch,
               Vectors3& x, SolveReport& report);
  bool solveDirectly(const BlockSystem& a, const Vectors3& b, double goal, Vectors3& x);

  LinearSolver solver_;
  bool isLaidOut_ = false;  ///< swept_, cholesky_ and coarse_ are of the system as it is
  SweptSystem swept_;
  IncompleteCholesky cholesky_;
  CoarseCorrection coarse_;
  BlockPcg pcg_;
  DirectSolve direct_;
  Vectors3 residual_;
  double norm_ = 0;                    ///< of the residual [kg m/s]
  double drift_ = 0;                   ///< by about how much it is off [kg m/s]
  std::vector<std::int32_t> stale_;    ///< rows whose residual has to be found again
  std::vector<std::uint8_t> isStale_;  ///< 1 for these
};

}  // namespace spume::foam
