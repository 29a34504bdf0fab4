#include <gtest/gtest.h>

#include "foam/near_walls.h"
#include "tests/foam_fixtures.h"

namespace spume::foam::test {
namespace {

constexpr double kRadius = 0.4e-3;  // [m]

/// Air above a floor at y = 0 and beside a wall at z = 0.
StillPool edge() {
  StillPoolParams pool;
  pool.lower = {-1e3, 0, 0}, pool.upper = {1e3, 1e3, 1e3};
  pool.surfaceHeight = -1e3;
  pool.closed = {false, false, true, false, true, false};
  return StillPool(pool);
}

NearWalls wallsOf(const StillPool& pool, const Eigen::Vector3d& x, double reach) {
  BubbleStore bubbles;
  bubbles.add(bubbleAt(x, kRadius));
  Surroundings around;
  around.sample(pool, bubbles.positions());
  std::vector<NearWalls> walls;
  findNearWalls(pool, around, bubbles, {reach}, walls);
  return walls.at(0);
}

TEST(NearWalls, ABubbleSeesAllItMayReachThoughAnotherIsFarNearer) {
  const Eigen::Vector3d x(0, 1.5 * kRadius, 3 * kRadius);  // a radius above it the floor is still the nearest
  const NearWalls walls = wallsOf(edge(), x, 3.5 * kRadius);
  ASSERT_EQ(walls.count, 2);
  EXPECT_NEAR(walls.wall[0].psi, x.y(), 1e-12);
  EXPECT_NEAR(walls.wall[1].psi, x.z(), 1e-12);
  EXPECT_NEAR(walls.wall[1].away.z(), 1, 1e-12);
  EXPECT_EQ(wallsOf(edge(), x, 2.9 * kRadius).count, 1) << "what it cannot reach does not count";
}

/// From a reach that sees the second wall to one that does not, and back.
TEST(NearWalls, AnotherReachLeavesNothingOfTheLastOneBehind) {
  const StillPool pool = edge();
  BubbleStore bubbles;
  bubbles.add(bubbleAt({0, 1.5 * kRadius, 3 * kRadius}, kRadius));
  Surroundings around;
  around.sample(pool, bubbles.positions());
  WallSearch search;
  std::vector<NearWalls> walls;
  search.find(pool, around, bubbles, {3.5 * kRadius}, walls);
  ASSERT_EQ(walls[0].count, 2);
  for (const double reach : {2.9, 3.5, 1.0, 3.5}) {
    search.findAgain(pool, around, bubbles, {reach * kRadius}, walls);
    const NearWalls fresh = wallsOf(pool, bubbles.position[0], reach * kRadius);
    ASSERT_EQ(walls[0].count, fresh.count) << reach;
    for (int k = 0; k < fresh.count; ++k) EXPECT_EQ(walls[0].wall[k].psi, fresh.wall[k].psi) << reach;
  }
}

TEST(NearWalls, NothingIsSeenFromBehindTheOppositePlate) {
  StillPoolParams plates;
  plates.lower = {-1e3, 0, -1e3}, plates.upper = {1e3, 6 * kRadius, 1e3};
  plates.closed = {false, false, true, true, false, false};
  const StillPool pool(plates);
  EXPECT_EQ(wallsOf(pool, {0, 2 * kRadius, 0}, 3 * kRadius).count, 1);
  EXPECT_EQ(wallsOf(pool, {0, 2 * kRadius, 0}, 20 * kRadius).count, 1);
}

/// Shot at the wall just above the floor, fast enough to pass three radii of it in a step.
TEST(NearWalls, NoBubbleIsShotThroughTheSideOfAnEdge) {
  constexpr double kStep = 0.016, kDeepest = 0.2;  // [s], [r]
  FoamParams params = makePreset(Preset::physical);
  params.bursting = false, params.gravity.setZero();
  BubbleStore bubbles;
  bubbles.add(bubbleAt({0, 1.5 * kRadius, 3 * kRadius}, kRadius, {0, 0, -6 * kRadius / kStep}));
  FoamSolver solver(params);
  const FoamStepReport report = solver.step(bubbles, edge(), kStep);
  EXPECT_LE(bubbles.position[0].z(), 1.5 * kRadius) << "it reached the wall";
  EXPECT_GE(bubbles.position[0].z(), -kDeepest * kRadius);
  EXPECT_EQ(report.pushedOut, 0u) << "the step itself stops it";
}

}  // namespace
}  // namespace spume::foam::test
