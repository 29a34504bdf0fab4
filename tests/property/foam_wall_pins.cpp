// Bubbles that stick to a solid while much goes on elsewhere.
#include <gtest/gtest.h>

#include "foam/forces/inertia.h"
#include "foam/forces/solid_adhesion.h"
#include "tests/foam_fixtures.h"

namespace spume::foam::test {
namespace {

constexpr double kWall = -0.03;  ///< of a glass pane at x [m]

/// A pane above water, to which bubbles stick.
StillPool paneAboveWater(const FoamParams& params) {
  StillPoolParams pool;
  pool.gravity = params.gravity, pool.density = params.density;
  pool.lower = {kWall, -1, -1};
  pool.closed[0] = true;
  return StillPool(pool);
}

FoamParams stickyParams() {
  FoamParams params = makePreset(Preset::physical);
  params.bursting = false;
  params.walls.adhesion = 0.02, params.walls.detachRadius = 0.8e-3;
  return params;
}

/// Small bubbles at rest on the pane, high above the water; all of their films weigh far less than the pins
/// hold.
void addStuck(int count, BubbleStore& bubbles) {
  for (int i = 0; i < count; ++i)
    bubbles.add(bubbleAt({kWall, 0.1, 5e-3 * i}, 0.5e-3, {0, 0, 0}, BubbleClass::air));
}

/// Bubbles pressed into each other, which fly apart.
void addBurstingHeap(int count, BubbleStore& bubbles) {
  for (int i = 0; i < count; ++i) {
    CounterRandom random(9, static_cast<std::uint64_t>(i), 1);
    const Eigen::Vector3d at(random.uniform(), random.uniform() - 0.5, random.uniform());
    bubbles.add(bubbleAt(0.008 * at, 0.5e-3 + 0.5e-3 * random.uniform()));
  }
}

/// Pins that hold less than half of what the films of a bubble of 0.5 mm weigh, in air without drag.
FoamParams slipperyParams() {
  FoamParams params = stickyParams();
  params.walls.detachRadius = 0.15e-3, params.gasViscosity = 0;
  return params;
}

/// A raft on the pane, its bubbles pressed into each other so that it spreads at first.
void addRaft(int edge, BubbleStore& bubbles) {
  for (int row = 0; row < edge; ++row)
    for (int column = 0; column < edge; ++column)
      bubbles.add(bubbleAt({kWall, 0.1 + 0.75e-3 * row, 0.85e-3 * (column + 0.5 * (row % 2))}, 0.5e-3,
                           {0, 0, 0}, BubbleClass::air));
}

/// Acceleration downwards of a bubble that slides: its weight less the pin's force, over its mass [m/s^2].
double slidingAcceleration(const FoamParams& params, const BubbleStore& bubbles) {
  const double mass = inertia(params, bubbles.gas[0], bubbles.wetness[0], 0);
  return params.gravity.norm() - pinningForce(params, params.walls) / mass;
}

double meanFall(const BubbleStore& bubbles) {
  double sum = 0;
  for (const auto& velocity : bubbles.velocity) sum -= velocity.y();
  return sum / static_cast<double>(bubbles.size());
}

/// Springs between bubbles add up to nothing, and every pin of a sliding crowd pulls with its force: none may
/// hold a bubble against more.
TEST(WallPins, ASlidingRaftFeelsTheForceOfEveryPin) {
  constexpr double kDt = 2e-3;
  constexpr int kSpreads = 25, kSlides = 25;
  // The brake is set to 5 %, for a slip that grows by a 25th a step or less.
  constexpr double kShare = 0.05;
  const FoamParams params = slipperyParams();
  const StillPool pane = paneAboveWater(params);
  BubbleStore bubbles;
  addRaft(7, bubbles);
  FoamSolver solver(params);
  for (int step = 0; step < kSpreads; ++step) solver.step(bubbles, pane, kDt);
  const double before = meanFall(bubbles), expected = slidingAcceleration(params, bubbles);
  ASSERT_GT(expected, 0.4 * params.gravity.norm());
  for (int step = 0; step < kSlides; ++step) solver.step(bubbles, pane, kDt);
  EXPECT_NEAR((meanFall(bubbles) - before) / (kSlides * kDt), expected, kShare * expected);
}

/// Friction stops a bubble that slides faster than its weight would have it, and does not send it back.
TEST(WallPins, FrictionStopsABubbleAndNoMore) {
  constexpr double kDt = 2e-3, kStill = 1e-6;
  FoamParams params = slipperyParams();
  params.walls.detachRadius = 0.25e-3;  // holds twice the weight
  const StillPool pane = paneAboveWater(params);
  BubbleStore bubbles;
  bubbles.add(bubbleAt({kWall, 0.1, 0}, 0.5e-3, {0, 0.1, 0}, BubbleClass::air));
  FoamSolver solver(params);
  solver.step(bubbles, pane, kDt);
  const double mass = inertia(params, bubbles.gas[0], bubbles.wetness[0], 0);
  const double braking = params.gravity.norm() + pinningForce(params, params.walls) / mass;
  for (double t = kDt; t < 10e-3; t += kDt) {
    EXPECT_NEAR(bubbles.velocity[0].y(), std::max(0.0, 0.1 - braking * t), kStill) << t;
    solver.step(bubbles, pane, kDt);
  }
}

/// A pin holds or gives way; what the iteration leaves open, or the friction of one that gave way, is no
/// reason to move.
TEST(WallPins, StuckBubblesStayWhateverHappensElsewhere) {
  constexpr double kStill = 1e-4;  // a pin gives way by a millionth of a free fall, about 2e-7 m/s a step
  const FoamParams params = stickyParams();
  const StillPool pane = paneAboveWater(params);
  BubbleStore bubbles;
  addStuck(20, bubbles);
  addBurstingHeap(400, bubbles);
  FoamSolver solver(params);
  for (int step = 0; step < 12; ++step) {
    solver.step(bubbles, pane, 1.0 / 60);
    for (int i = 0; i < 20; ++i) {
      ASSERT_TRUE(bubbles.touchedSolid[i]) << step << " " << i;
      ASSERT_LT(bubbles.velocity[i].norm(), kStill) << step << " " << i;
    }
  }
}

/// The step that catches a bubble is solved as finely as any other: those far from it come to the same places
/// as without it, to what the solver's tolerance leaves of their 0.1 mm.
TEST(WallPins, CatchingABubbleLeavesTheRestOfTheStepAsAccurate) {
  constexpr int kHeap = 200;
  constexpr double kSame = 1e-7;  // [m]
  FoamParams params = stickyParams();
  params.solverTolerance = 1e-6;
  const StillPool pane = paneAboveWater(params);
  const auto stepped = [&](bool withArrival) {
    BubbleStore bubbles;
    addBurstingHeap(kHeap, bubbles);
    if (withArrival)
      bubbles.add(bubbleAt({kWall + 0.2e-3, 0.1, 0}, 0.5e-3, {-0.05, 0.5, 0}, BubbleClass::air));
    FoamSolver(params).step(bubbles, pane, 1.0 / 60);
    return bubbles;
  };
  const BubbleStore with = stepped(true), without = stepped(false);
  for (int i = 0; i < kHeap; ++i) EXPECT_LT((with.position[i] - without.position[i]).norm(), kSame) << i;
  EXPECT_TRUE(with.touchedSolid[kHeap]);
  EXPECT_LT(std::abs(with.velocity[kHeap].y()), 1e-3);
}

}  // namespace
}  // namespace spume::foam::test
