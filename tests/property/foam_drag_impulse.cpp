// What the liquid's drag gives the bubbles, which two-way coupling takes from the liquid.
#include <gtest/gtest.h>

#include <cmath>

#include "foam/forces/inertia.h"
#include "tests/foam_fixtures.h"

namespace spume::foam::test {
namespace {

using Eigen::Vector3d;

constexpr double kDt = 5e-3;  // [s]

Vector3d totalDrag(const FoamSolver& solver) {
  Vector3d sum = Vector3d::Zero();
  for (const DragImpulse& drag : solver.dragImpulses()) sum += drag.impulse;
  return sum;
}

/// Buoyancy less weight of all bubbles, wholly immersed [N].
Vector3d totalLift(const FoamParams& params, const BubbleStore& bubbles) {
  double gas = 0;
  for (const double each : bubbles.gas) gas += each;
  return -(params.density - params.gasDensity) * gas * params.gravity;
}

Vector3d momentum(const FoamParams& params, const BubbleStore& bubbles) {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 0; i < bubbles.size(); ++i)
    sum += inertia(params, bubbles.gas[i], bubbles.wetness[i], 1) * bubbles.velocity[i];
  return sum;
}

/// accuracy, B5: beside the outer forces, drag alone changes the bubbles' momentum, however they push each
/// other.
TEST(DragImpulse, ClosesTheBalanceOfMomentum) {
  constexpr double kRelative = 1e-9;  // sums of 300 terms, and a system solved to 1e-10
  FoamParams params = waterParams(Preset::physical);
  params.solverTolerance = 1e-10;
  const StillPool pool = deepPool(params, {0.2, -0.1, 0.05});
  BubbleStore bubbles;
  for (int i = 0; i < 300; ++i) {
    CounterRandom random(5, static_cast<std::uint64_t>(i), 1);
    const Vector3d at(random.uniform(), random.uniform(), random.uniform());
    bubbles.add(bubbleAt(0.01 * at, 0.4e-3 + 0.6e-3 * random.uniform()));
  }
  FoamSolver solver(params);
  for (int step = 0; step < 5; ++step) {
    const Vector3d before = momentum(params, bubbles);
    solver.step(bubbles, pool, kDt);
    const Vector3d change = momentum(params, bubbles) - before, lift = kDt * totalLift(params, bubbles);
    EXPECT_LT((change - lift - totalDrag(solver)).norm(), kRelative * lift.norm()) << step;
  }
}

/// Afloat, level with the liquid, with everything that acts between bubbles: springs, damping, attraction,
/// films that draw their borders, cells that hold their volumes. Without films and added mass a bubble's
/// inertia is that of its gas, whatever of it is immersed.
TEST(DragImpulse, ClosesTheBalanceOfAFloatingCrowdUnderEveryInternalForce) {
  constexpr double kRelative = 1e-12;  // round-off of 200 terms, over all that drag exchanges
  for (const Preset preset : {Preset::paper, Preset::physical}) {
    FoamParams params = makePreset(preset);
    params.bursting = false, params.addedMass = 0, params.wetness = params.wetnessAloft = 0;
    params.airDragCoefficient = params.gasViscosity = 0;  // the air takes nothing
    params.borderRate = 4, params.volumeMode = VolumeMode::newton;
    ASSERT_NE(params.attractionLaw, AttractionLaw::none);
    BubbleStore bubbles;
    for (int i = 0; i < 200; ++i) {
      CounterRandom random(9, static_cast<std::uint64_t>(i), 1);
      const double x = random.uniform(), z = random.uniform();
      const double r = 0.4e-3 + 0.8e-3 * random.uniform();
      bubbles.add(bubbleAt({0.03 * x, 0, 0.03 * z}, r, {0.02 * (x - z), 0, 0.01}, BubbleClass::surface));
    }
    FoamSolver solver(params);
    const StillPool pool = openPool(params);
    for (int step = 0; step < 20; ++step) {
      const BubbleStore before = bubbles;
      solver.step(bubbles, pool, kDt);
      ASSERT_EQ(bubbles.id, before.id);
      Vector3d unbalanced = -totalDrag(solver);
      double exchanged = 0;
      for (std::size_t i = 0; i < bubbles.size(); ++i)
        unbalanced += params.gasDensity * bubbles.gas[i] * (bubbles.velocity[i] - before.velocity[i]);
      for (const DragImpulse& drag : solver.dragImpulses()) exchanged += drag.impulse.norm();
      EXPECT_LT(std::hypot(unbalanced.x(), unbalanced.z()), kRelative * exchanged) << step;
    }
  }
}

/// At its terminal speed a bubble hands its whole lift to the liquid.
TEST(DragImpulse, IsTheLiftOfABubbleThatRisesSteadily) {
  constexpr double kRelative = 1e-6;  // of the approach to the terminal speed, after 1 s
  const FoamParams params = waterParams(Preset::physical);
  const StillPool pool = deepPool(params);
  BubbleStore bubbles;
  bubbles.add(bubbleAt({0, 0, 0}, 1e-3));
  FoamSolver solver(params);
  for (int step = 0; step < 200; ++step) solver.step(bubbles, pool, kDt);
  const Vector3d lift = kDt * totalLift(params, bubbles);
  EXPECT_LT((totalDrag(solver) + lift).norm(), kRelative * lift.norm());
  ASSERT_EQ(solver.dragImpulses().size(), 1u);
  EXPECT_NEAR(solver.dragImpulses()[0].slip, bubbles.velocity[0].norm(), 1e-9);
}

TEST(DragImpulse, IsNoneHighAboveTheLiquid) {
  FoamParams params = waterParams(Preset::physical);
  BubbleStore bubbles;
  bubbles.add(bubbleAt({0, 0.5, 0}, 1e-3, {1, 0, 0}, BubbleClass::air));
  FoamSolver solver(params);
  solver.step(bubbles, openPool(params), kDt);
  EXPECT_TRUE(solver.dragImpulses().empty());
}

}  // namespace
}  // namespace spume::foam::test
