// The foam step at the ends of its range (accuracy, 7).
#include <gtest/gtest.h>

#include "foam/errors.h"
#include "tests/foam_fixtures.h"

namespace spume::foam::test {
namespace {

FoamParams quiet(Preset preset) {
  FoamParams params = makePreset(preset);
  params.bursting = false;
  return params;
}

TEST(FoamExtremes, NoOneAndTwoBubbles) {
  const FoamParams params = quiet(Preset::physical);
  const StillPool pool = openPool(params);
  for (int n = 0; n <= 2; ++n) {
    BubbleStore bubbles;
    for (int i = 0; i < n; ++i) bubbles.add(bubbleAt({1.5e-3 * i, -5e-3, 0}, 1e-3));
    FoamSolver solver(params);
    for (int step = 0; step < 50; ++step)
      EXPECT_EQ(solver.step(bubbles, pool, 0.01).bubbles, static_cast<std::size_t>(n));
    for (const auto& x : bubbles.position) EXPECT_TRUE(x.allFinite());
  }
}

TEST(FoamExtremes, CoincidentBubblesPartWithoutMomentum) {
  for (const double ratio : {1.0, 0.5}) {
    FoamParams params = quiet(Preset::paper);
    params.gravity.setZero();
    params.airDragCoefficient = 0;
    BubbleStore bubbles;
    bubbles.add(bubbleAt({0, 0, 0}, 1e-3, {0, 0, 0}, BubbleClass::air));
    bubbles.add(bubbleAt({0, 0, 0}, ratio * 1e-3, {0, 0, 0}, BubbleClass::air));
    FoamSolver solver(params);
    const StillPool space = emptySpace();
    for (int step = 0; step < 400; ++step) {
      solver.step(bubbles, space, 0.005);
      // Pulled apart by at most the rest length within a step.
      ASSERT_LE(bubbles.velocity[0].norm() + bubbles.velocity[1].norm(), 2e-3 / 0.005);
    }
    EXPECT_EQ(bubbles.size(), 2u);
    EXPECT_GT((bubbles.position[0] - bubbles.position[1]).norm(), 0.5e-3);
    EXPECT_EQ(bubbles.hidden[1], 0);
    const Eigen::Vector3d momentum =
        bubbles.gas[0] * bubbles.velocity[0] + bubbles.gas[1] * bubbles.velocity[1];
    EXPECT_LE(momentum.norm(), 1e-20);
  }
}

TEST(FoamExtremes, AHundredBubblesAtOnePointSeparate) {
  FoamParams params = quiet(Preset::physical);
  params.gravity.setZero();
  BubbleStore bubbles;
  for (int i = 0; i < 100; ++i) bubbles.add(bubbleAt({0, 0, 0}, 1e-3, {0, 0, 0}, BubbleClass::air));
  FoamSolver solver(params);
  const StillPool space = emptySpace();
  FoamStepReport report;
  for (int step = 0; step < 400; ++step) {
    report = solver.step(bubbles, space, 0.005);
    ASSERT_LE(report.maxSpeed, 10e-3 / 0.005);  // a step moves nobody further than the pile will be wide
  }
  EXPECT_EQ(report.bubbles, 100u);
  EXPECT_EQ(report.hidden, 0u);
}

TEST(FoamExtremes, LargeAndTinyBubblesInContact) {
  for (const double ratio : {20.0, 200.0, 1000.0}) {
    const FoamParams params = quiet(Preset::physical);
    BubbleStore bubbles;
    bubbles.add(bubbleAt({0, -20e-3, 0}, 5e-3));
    bubbles.add(bubbleAt({5e-3, -20e-3, 0}, 5e-3 / ratio));
    FoamSolver solver(params);
    const StillPool pool = openPool(params);
    for (int step = 0; step < 100; ++step) solver.step(bubbles, pool, 0.005);
    EXPECT_EQ(bubbles.size(), 2u);
    for (const auto& x : bubbles.position) EXPECT_TRUE(x.allFinite());
    EXPECT_LE(bubbles.position[0].y(), 5e-3);
  }
}

TEST(FoamExtremes, NothingActsWhenEveryCoefficientIsZero) {
  // Exact parabola of backward Euler: y = -g dt^2 n (n + 1) / 2.
  FoamParams params = quiet(Preset::paper);
  params.springStiffness = 0, params.springFloor = 0, params.dragCoefficient = 0,
  params.airDragCoefficient = 0;
  params.liquidAdhesion = 0, params.wallStiffnessFactor = 0, params.contactDamping = 0, params.volumeRate = 0;
  params.viscosity = 1e-5;
  StillPoolParams dry;
  dry.surfaceHeight = -1e3;
  BubbleStore bubbles;
  bubbles.add(bubbleAt({0, 0, 0}, 1e-3, {0.3, 0, 0}, BubbleClass::air));
  bubbles.add(bubbleAt({1e-3, 0, 0}, 1e-3, {0.3, 0, 0}, BubbleClass::air));
  FoamSolver solver(params);
  for (int step = 0; step < 20; ++step) solver.step(bubbles, StillPool(dry), 0.01);
  EXPECT_NEAR(bubbles.position[0].y(), -9.8 * 1e-4 * 20 * 21 / 2, 1e-14);
  EXPECT_NEAR(bubbles.position[0].x(), 0.06, 1e-15);
}

TEST(FoamExtremes, GravityOfAnySizeAndDirection) {
  for (const Eigen::Vector3d& gravity : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0, -980, 0),
                                         Eigen::Vector3d(9.8, 0, 0), Eigen::Vector3d(0, 9.8, 0)}) {
    FoamParams params = quiet(Preset::physical);
    params.gravity = gravity;
    const Eigen::Vector3d up =
        gravity.norm() > 0 ? Eigen::Vector3d(-gravity.normalized()) : Eigen::Vector3d::UnitY();
    BubbleStore bubbles;
    for (int i = 0; i < 20; ++i)
      bubbles.add(bubbleAt(-5e-3 * up + 1.3e-3 * i * Eigen::Vector3d::UnitZ(), 1e-3));
    FoamSolver solver(params);
    const StillPool pool = openPool(params);
    FoamStepReport report;
    for (int step = 0; step < 200; ++step) report = solver.step(bubbles, pool, 0.01);
    EXPECT_EQ(gravity.norm() > 0 ? report.surface : report.liquid, 20u);
  }
}

TEST(FoamExtremes, StepsOfAnyLengthStayFinite) {
  const FoamParams params = quiet(Preset::physical);
  const StillPool pool = openPool(params);
  BubbleStore bubbles;
  for (int i = 0; i < 60; ++i) {
    CounterRandom random(31, static_cast<std::uint64_t>(i), 0);
    bubbles.add(
        bubbleAt({8e-3 * random.uniform(), -10e-3 * random.uniform(), 8e-3 * random.uniform()}, 1e-3));
  }
  FoamSolver solver(params);
  for (int step = 0; step < 200; ++step) {
    const double dt = step % 3 == 0 ? 1e-6 : step % 3 == 1 ? 1e-4 : 0.1;
    ASSERT_LE(solver.step(bubbles, pool, dt).maxSpeed, 50) << step;
  }
  EXPECT_EQ(bubbles.size(), 60u);
}

TEST(FoamExtremes, ABubbleLargerThanItsBoxStaysInside) {
  const FoamParams params = quiet(Preset::physical);
  StillPoolParams box;
  box.lower = {-5e-3, -5e-3, -5e-3}, box.upper = {5e-3, 5e-3, 5e-3};
  box.closed = {true, true, true, true, true, true};
  BubbleStore bubbles;
  bubbles.add(bubbleAt({1e-3, -1e-3, 0}, 8e-3));
  FoamSolver solver(params);
  for (int step = 0; step < 200; ++step) solver.step(bubbles, StillPool(box), 0.01);
  EXPECT_LE(bubbles.position[0].cwiseAbs().maxCoeff(), 5e-3);
}

}  // namespace
}  // namespace spume::foam::test
