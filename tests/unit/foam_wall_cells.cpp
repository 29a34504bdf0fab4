// Power cells cut by solids.
#include <gtest/gtest.h>

#include "foam/volume_correction.h"
#include "foam/wall_cells.h"
#include "tests/foam_fixtures.h"
#include "tests/support/foam_balls.h"

namespace spume::foam::test {
namespace {

constexpr double kRoundOff = 1e-9;  // of a volume of order 1; ties are broken at this level

/// Space above a floor at height 0.
StillPool floorAtZero() {
  StillPoolParams pool;
  pool.lower = {-1e3, 0, -1e3}, pool.upper = {1e3, 1e3, 1e3};
  pool.closed = {false, false, true, false, false, false};
  return StillPool(pool);
}

FoamTopology wallCellsOf(const BubbleStore& bubbles, const StillPool& pool,
                         Connectivity engine = Connectivity::local) {
  Surroundings around;
  around.sample(pool, bubbles.positions());
  std::vector<NearWalls> walls;
  findNearWalls(pool, around, bubbles, bubbles.radius, walls);
  FoamTopology topology;
  WallCells(engine).compute(bubbles, walls, topology);
  return topology;
}

FoamTopology wallCellsOf(const BubbleStore& bubbles) { return wallCellsOf(bubbles, floorAtZero()); }

TEST(WallCells, ABallLosesItsCapBehindThePlane) {
  for (const double psi : {-0.9, -0.3, 0.0, 0.3, 0.9}) {
    BubbleStore bubbles;
    bubbles.add(bubbleAt({0.1, psi, 0.2}, 1));
    const FoamTopology topology = wallCellsOf(bubbles);
    const double cap = 1 - psi;
    EXPECT_NEAR(topology.volume.at(0), ballVolume(1) - capVolume(1, cap), kRoundOff) << psi;
    EXPECT_NEAR(topology.freeArea.at(0), 2 * std::numbers::pi * (2 - cap), kRoundOff) << psi;
    EXPECT_NEAR(topology.filmArea.at(0), 0, kRoundOff);
    EXPECT_TRUE(topology.films.empty() && topology.overlaps.empty());
  }
}

TEST(WallCells, ABallBetweenPlatesLosesBothCaps) {
  StillPoolParams plates;
  plates.lower = {-1e3, -1e3, 0}, plates.upper = {1e3, 1e3, 1.2};
  plates.closed = {false, false, false, false, true, true};
  BubbleStore bubbles;
  bubbles.add(bubbleAt({0, 0, 0.6}, 1));
  const FoamTopology topology = wallCellsOf(bubbles, StillPool(plates));
  EXPECT_NEAR(topology.volume.at(0), ballVolume(1) - 2 * capVolume(1, 0.4), kRoundOff);
}

TEST(WallCells, ABallOnAnEdgeKeepsAQuarter) {
  StillPoolParams edge;
  edge.lower = {-1e3, 0, 0}, edge.upper = {1e3, 1e3, 1e3};
  edge.closed = {false, false, true, false, true, false};
  BubbleStore bubbles;
  bubbles.add(bubbleAt({0, 0, 0}, 1));
  EXPECT_NEAR(wallCellsOf(bubbles, StillPool(edge)).volume.at(0), ballVolume(1) / 4, kRoundOff);
}

TEST(WallCells, APairOnTheFloorIsHalfAPair) {
  // By symmetry: two unit balls with centres on the floor, 1 apart (accuracy, V1).
  BubbleStore bubbles;
  bubbles.add(bubbleAt({0, 0, 0}, 1)), bubbles.add(bubbleAt({1, 0, 0}, 1));
  const FoamTopology topology = wallCellsOf(bubbles);
  for (const double volume : topology.volume) EXPECT_NEAR(volume, 3.534291735289 / 2, kRoundOff);
  ASSERT_EQ(topology.films.size(), 1u);
  ASSERT_EQ(topology.overlaps.size(), 1u);
  EXPECT_EQ(topology.overlaps[0].film, 0);
  EXPECT_NEAR(topology.films[0].area, std::numbers::pi * 0.75 / 2, kRoundOff);
  EXPECT_NEAR(topology.filmArea[0], std::numbers::pi * 0.75 / 2, kRoundOff);
}

TEST(WallCells, ADenseFoamOnAFloorIsThatOfItsMirrorImage) {
  // A foam and its image behind the floor: the cells of the upper half are those the floor cuts.
  Balls balls = randomFoam(150, 0.2, 2, 0.9, 4);
  BubbleStore bubbles;
  for (std::size_t i = 0; i < balls.size(); ++i) bubbles.add(bubbleAt(balls.position[i], balls.radius[i]));
  Balls both = balls;
  for (std::size_t i = 0; i < balls.size(); ++i)
    both.add(balls.position[i].cwiseProduct(Eigen::Vector3d(1, -1, 1)), balls.radius[i]);
  const FoamTopology cut = wallCellsOf(bubbles), mirrored = powerCellsOf(both);
  int atWall = 0;
  for (std::size_t i = 0; i < balls.size(); ++i) {
    const double psi = balls.position[i].y(), r = balls.radius[i];
    if (psi > kCutByWall * r && psi < r) continue;  // caps that are not worth a plane
    atWall += psi < r;
    EXPECT_NEAR(cut.volume[i], mirrored.volume[i], 1e-3 * ballVolume(r)) << i;
    EXPECT_EQ(cut.hidden[i], mirrored.hidden[i]);
  }
  EXPECT_GT(atWall, 10);
  EXPECT_EQ(cut.volume.size(), balls.size());
}

TEST(WallCells, BothEnginesCutAlike) {
  const Balls balls = randomFoam(150, 0.4, 3, 0.9, 6);
  BubbleStore bubbles;
  for (std::size_t i = 0; i < balls.size(); ++i) bubbles.add(bubbleAt(balls.position[i], balls.radius[i]));
  StillPoolParams corner;
  corner.lower = {0, 0, -1e3}, corner.upper = {1e3, 1e3, 1e3};
  corner.closed = {true, false, true, false, false, false};
  const FoamTopology local = wallCellsOf(bubbles, StillPool(corner));
  const FoamTopology global = wallCellsOf(bubbles, StillPool(corner), Connectivity::global);
  EXPECT_EQ(local.hidden, global.hidden);
  ASSERT_EQ(local.overlaps.size(), global.overlaps.size());
  for (std::size_t p = 0; p < local.overlaps.size(); ++p)
    EXPECT_EQ(local.overlaps[p].film, global.overlaps[p].film) << p;
  for (std::size_t i = 0; i < balls.size(); ++i) {
    const double r = balls.radius[i];
    EXPECT_NEAR(local.volume[i], global.volume[i], kRoundOff * ballVolume(r)) << i;
    EXPECT_NEAR(local.freeArea[i], global.freeArea[i], 10 * kRoundOff * r * r) << i;
    EXPECT_NEAR(local.filmArea[i], global.filmArea[i], 10 * kRoundOff * r * r) << i;
  }
}

TEST(WallCells, AwayFromWallsNothingChanges) {
  Balls balls = randomFoam(100, 0.2, 2, 0.9, 5);
  BubbleStore bubbles;
  for (std::size_t i = 0; i < balls.size(); ++i) {
    balls.position[i].y() += 5;
    bubbles.add(bubbleAt(balls.position[i], balls.radius[i]));
  }
  const FoamTopology cells = wallCellsOf(bubbles), plain = powerCellsOf(balls);
  EXPECT_EQ(cells.volume, plain.volume);
  EXPECT_EQ(cells.films.size(), plain.films.size());
}

TEST(WallCells, ABubbleBehindItsPlaneHasNoVolume) {
  BubbleStore bubbles;
  bubbles.add(bubbleAt({0, -0.99, 0}, 1));
  EXPECT_EQ(wallCellsOf(bubbles).volume.at(0), 0);
}

TEST(WallCells, AHalfBallGrowsUntilItHoldsItsGas) {
  BubbleStore bubbles;
  bubbles.add(bubbleAt({0, 0, 0}, 1e-3));
  for (int step = 0; step < 500; ++step) correctVolumes(FoamParams(), wallCellsOf(bubbles), 0.02, bubbles);
  EXPECT_NEAR(bubbles.radius[0], 1e-3 * std::cbrt(2.0), 1e-12);
}

}  // namespace
}  // namespace spume::foam::test
