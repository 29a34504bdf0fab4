// The linear solvers against each other, through whole steps of relaxed foams.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "tests/foam_fixtures.h"
#include "tests/support/foam_relaxed.h"

namespace spume::foam::test {
namespace {

/// A block of relaxed foam, half out of a pool, every third bubble pushed.
BubbleStore stirredFoam(const Balls& balls) {
  BubbleStore bubbles;
  for (std::size_t i = 0; i < balls.size(); ++i) {
    const Eigen::Vector3d velocity(i % 3 == 0 ? 0.1 : 0, 0, 0);
    bubbles.add(bubbleAt(balls.position[i] - Eigen::Vector3d(0, 5e-3, 0), balls.radius[i], velocity));
  }
  return bubbles;
}

Vectors3 velocitiesAfterStep(const Balls& balls, double wetness, LinearSolver solver, double tolerance) {
  FoamParams params = waterParams(Preset::physical);
  params.wetness = params.wetnessAloft = wetness;
  params.solver = solver, params.solverTolerance = tolerance, params.solverIterations = 5000;
  FoamSolver foam(params);
  BubbleStore bubbles = stirredFoam(balls);
  EXPECT_FALSE(foam.step(bubbles, openPool(params), 5e-3).solverFellBack);
  return bubbles.velocity;
}

TEST(LinearSolvers, AgreeOnWetAndDenseFoams) {
  constexpr double kTolerance = 1e-10;
  /// Residual x conditioning: springs are up to 1e4 times as stiff as the inertia of the step.
  constexpr double kAgreement = 1e-6;
  for (const double wetness : {0.8, 0.4})
    for (std::uint64_t seed : {1, 2}) {
      const Balls balls = relaxedFoam(500, wetness, seed);
      const auto solved = [&](LinearSolver solver) {
        return velocitiesAfterStep(balls, wetness, solver, kTolerance);
      };
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

TEST(LinearSolvers, ThreadsDoNotChangeABitOfAStep) {
  const Balls balls = relaxedFoam(3000, 0.4, 3);  // two blocks of rows
  for (const LinearSolver solver : {LinearSolver::pcgJacobi, LinearSolver::pcgIncompleteCholesky}) {
    const auto withThreads = [&](std::size_t threads) {
      tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      return velocitiesAfterStep(balls, 0.4, solver, 1e-6);
    };
    const Vectors3 alone = withThreads(1);
    for (std::size_t threads : {2, 4}) EXPECT_EQ(alone, withThreads(threads));
  }
}

}  // namespace
}  // namespace spume::foam::test
