// The linear solvers against each other, through whole steps of relaxed foams.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "foam/foam_solver.h"
#include "tests/support/floating_foam.h"

namespace spume::foam::test {
namespace {

/// Velocities after one step of 5 ms from rest, every third bubble pushed.
Vectors3 velocitiesAfterStep(FloatingFoam foam, LinearSolver solver, double tolerance) {
  for (std::size_t i = 0; i < foam.bubbles.size(); i += 3) foam.bubbles.velocity[i].x() = 0.1;
  foam.params.solver = solver, foam.params.solverTolerance = tolerance, foam.params.solverIterations = 5000;
  EXPECT_FALSE(FoamSolver(foam.params).step(foam.bubbles, StillPool(foam.box), 5e-3).solverFellBack);
  return foam.bubbles.velocity;
}

TEST(LinearSolvers, AgreeOnWetAndDenseFoams) {
  constexpr double kTolerance = 1e-10;
  /// Residual x conditioning: springs are up to 1e4 times as stiff as the inertia of the step.
  constexpr double kAgreement = 1e-6;
  for (const double wetness : {0.8, 0.4})
    for (std::uint64_t seed : {1, 2}) {
      const FloatingFoam foam(500, wetness, seed);
      const auto solved = [&](LinearSolver solver) { return velocitiesAfterStep(foam, solver, kTolerance); };
      const Vectors3 direct = solved(LinearSolver::cholmod), jacobi = solved(LinearSolver::pcgJacobi),
                     cholesky = solved(LinearSolver::pcgIncompleteCholesky);
      double fastest = 0;
      for (const auto& v : direct) fastest = std::max(fastest, v.norm());
      EXPECT_GT(fastest, 0.01);
      for (std::size_t i = 0; i < direct.size(); ++i) {
        EXPECT_LE((jacobi[i] - direct[i]).norm(), kAgreement * fastest)
            << "wetness " << wetness << " bubble " << i;
        EXPECT_LE((cholesky[i] - direct[i]).norm(), kAgreement * fastest);
      }
    }
}

TEST(LinearSolvers, AgreeWhereClustersCorrect) {
  const FloatingFoam foam(9000, 0.4);
  const Vectors3 jacobi = velocitiesAfterStep(foam, LinearSolver::pcgJacobi, 1e-10),
                 cholesky = velocitiesAfterStep(foam, LinearSolver::pcgIncompleteCholesky, 1e-10);
  for (std::size_t i = 0; i < jacobi.size(); ++i) EXPECT_LE((cholesky[i] - jacobi[i]).norm(), 1e-7) << i;
}

TEST(LinearSolvers, ThreadsDoNotChangeABitWhereClustersCorrect) {
  const auto withThreads = [](std::size_t threads) {
    tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return velocitiesAfterStep(FloatingFoam(9000, 0.4), LinearSolver::pcgIncompleteCholesky, 1e-6);
  };
  EXPECT_EQ(withThreads(1), withThreads(4));
}

TEST(LinearSolvers, ThreadsDoNotChangeABitOfAStep) {
  const FloatingFoam foam(3000, 0.4);  // two blocks of rows
  for (const LinearSolver solver : {LinearSolver::pcgJacobi, LinearSolver::pcgIncompleteCholesky}) {
    const auto withThreads = [&](std::size_t threads) {
      tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      return velocitiesAfterStep(foam, solver, 1e-6);
    };
    const Vectors3 alone = withThreads(1);
    for (std::size_t threads : {2, 4}) EXPECT_EQ(alone, withThreads(threads));
  }
}

}  // namespace
}  // namespace spume::foam::test
