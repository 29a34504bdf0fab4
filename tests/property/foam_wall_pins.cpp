// Bubbles that stick to a solid while much goes on elsewhere.
#include <gtest/gtest.h>

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
  const FoamParams params = stickyParams();
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
