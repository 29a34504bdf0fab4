#include <gtest/gtest.h>

#include <numeric>
#include <random>

#include "fluid/marker_correction.h"
#include "fluid/marker_particles.h"
#include "tests/support/fluid_fields.h"
#include "tests/support/marker_pool.h"

namespace spume::fluid {
namespace {

using namespace test;

TEST(MarkerSeeder, FillsTheBandOnBothSides) {
  Pool pool(24, flat);
  pool.seed();
  // The band of 3 cells: 3 full layers of cells above the surface (which lies on a face) and as many below.
  const std::size_t full = 3 * 24 * 24 * pool.params.markersPerCell;
  EXPECT_EQ(pool.positive.size(), full);
  EXPECT_EQ(pool.negative.size(), full);
  for (std::size_t n = 0; n < pool.positive.size(); ++n) {
    const double depth = pool.positive.y[n] - 12;
    EXPECT_GE(depth, 0.0999);
    EXPECT_LE(depth, 3.0001);
    EXPECT_NEAR(pool.positive.radius[n], std::clamp(depth, 0.1, 0.5), 1e-4);
  }
  for (std::size_t n = 0; n < pool.negative.size(); ++n) EXPECT_LE(pool.negative.y[n], 11.9001);
}

TEST(MarkerSeeder, LeavesASeededBandAlone) {
  Pool pool(24, sphere);
  pool.seed();
  const MarkerSet before = pool.positive;
  pool.seed(1);
  // A second round may top up cells whose first attempts failed, but neither moves nor deletes.
  EXPECT_GE(pool.positive.size(), before.size());
  EXPECT_LE(pool.positive.size(), before.size() * 1.05);
}

TEST(MarkerSeeder, NeverTouchesEscapedMarkers) {
  Pool pool(24, flat);
  pool.positive.append(12.3f, 3, 12.1f, 0.1f);  // deep in the liquid
  pool.positive.escaped[0] = 1;
  pool.seed();
  EXPECT_EQ(std::count(pool.positive.escaped.begin(), pool.positive.escaped.end(), 1), 1);
}

TEST(MarkerSeeder, GivesTheSameMarkersOnAnyNumberOfThreads) {
  const auto run = [](int threads) {
    return onThreads(threads, [] {
      Pool pool(24, sphere);
      pool.seed(7);
      return pool.positive;
    });
  };
  const MarkerSet one = run(1), four = run(4);
  EXPECT_EQ(one.x, four.x);
  EXPECT_EQ(one.y, four.y);
  EXPECT_EQ(one.z, four.z);
}

TEST(MarkerSorter, SortsByCellAndKeepsTheOrderInside) {
  const GridSpec grid = unitCube(4);
  MarkerSet markers;
  markers.append(3.5f, 0.5f, 0.5f, 0.3f);
  markers.append(0.5f, 0.5f, 2.5f, 0.1f);
  markers.append(NAN, 0.5f, 0.5f, 0.4f);
  markers.append(0.5f, 0.6f, 2.1f, 0.2f);
  MarkerSorter sorter(grid);
  sorter.sort(markers);
  EXPECT_EQ(markers.radius, (LargeVector<float>{0.1f, 0.2f, 0.3f}));
  EXPECT_EQ(sorter.cellStart()[2], 0);
  EXPECT_EQ(sorter.cellStart()[3], 2);
  EXPECT_EQ(sorter.cellStart().back(), 3);
}

TEST(MarkerSorter, InsertsAsSortingAllAgainWould) {
  const GridSpec grid = unitCube(8);
  std::mt19937 random(3);
  std::uniform_real_distribution<float> within(0, 8);
  const auto draw = [&](MarkerSet& set) {
    set.append(within(random), within(random), within(random), within(random));
  };
  MarkerSet markers, added;
  for (int n = 0; n < 4000; ++n) draw(markers);
  for (int n = 0; n < 700; ++n) draw(added);
  MarkerSorter sorter(grid), another(grid);
  another.sort(added);
  sorter.sort(markers);
  for (std::size_t n = 0; n < markers.size(); n += 3) markers.x[n] = NAN;
  std::vector<MarkerSet> slabs(8);
  MarkerSet all = markers;
  for (std::size_t n = 0; n < added.size(); ++n)
    for (MarkerSet* set : {&all, &slabs[static_cast<int>(added.x[n])]})
      set->append(added.x[n], added.y[n], added.z[n], added.radius[n]);
  sorter.insert(slabs, markers);
  another.sort(all);
  EXPECT_EQ(markers.x, all.x);
  EXPECT_EQ(markers.y, all.y);
  EXPECT_EQ(markers.z, all.z);
  EXPECT_EQ(markers.radius, all.radius);
  EXPECT_EQ(markers.gas, all.gas);
  EXPECT_EQ(markers.escaped, all.escaped);
}

TEST(AdvectMarkers, TurnsWithARigidRotationToSecondOrder) {
  const GridSpec grid = unitCube(32);
  const auto spin = [](const Eigen::Vector3d& x) { return Eigen::Vector3d(0.5 - x.y(), x.x() - 0.5, 0); };
  const MacVelocity velocity = macField(grid, spin);  // linear: sampled exactly
  const Pool pool(32, flat);
  double error[2];
  for (const int level : {0, 1}) {
    MarkerSet markers;
    markers.append(24, 16, 16, 0.1f);
    const int steps = 8 << level;
    for (int step = 0; step < steps; ++step) advectMarkers(pool.scene(), velocity, 1.0 / steps, markers);
    error[level] = std::hypot(markers.x[0] - 16 - 8 * std::cos(1.0), markers.y[0] - 16 - 8 * std::sin(1.0));
  }
  EXPECT_GT(std::log2(error[0] / error[1]), 1.8);
}

TEST(AdvectMarkers, KeepsMarkersOffWallsAndLetsThemLeaveOpenSides) {
  DomainWalls walls = closedWalls();
  walls.closed[1] = false;
  Pool pool(16, flat, walls);
  const MacVelocity wind = macField(pool.grid, [](const auto&) { return Eigen::Vector3d(1, -1, 0); });
  MarkerSet markers;
  markers.append(15, 0.5f, 8, 0.1f);
  markers.append(5, 0.5f, 8, 0.1f);
  advectMarkers(pool.scene(), wind, 2 * pool.grid.dx, markers);
  MarkerSorter(pool.grid).compact(markers);
  ASSERT_EQ(markers.size(), 1u);
  EXPECT_FLOAT_EQ(markers.x[0], 7);
  EXPECT_NEAR(markers.y[0], 0.1f, 1e-6);
}

TEST(MarkerCorrection, LeavesAConsistentSurfaceAlone) {
  Pool pool(24, sphere);
  pool.seed();
  DenseField<float> phi = pool.phi;
  MarkerCorrection correction;
  correction.apply(static_cast<float>(pool.grid.dx), pool.solids.sides, pool.positive, pool.negative, phi);
  EXPECT_EQ(correction.escapedCount(), 0u);
  EXPECT_TRUE(sameBits(phi, pool.phi));
}

TEST(MarkerCorrection, BringsBackASurfaceThatWasMovedAway) {
  Pool pool(32, sphere);
  pool.params.markersPerCell = 64;
  pool.seed();
  for (const double shift : {-0.6, 0.6}) {  // cells: the sphere has shrunk or grown
    DenseField<float> phi =
        levelSet(pool.grid, [&](const auto& x) { return sphere(x) - shift * pool.grid.dx; });
    MarkerCorrection correction;
    DenseField<float> again = phi;
    correction.apply(static_cast<float>(pool.grid.dx), pool.solids.sides, pool.positive, pool.negative, phi);
    correction.apply(static_cast<float>(pool.grid.dx), pool.solids.sides, pool.positive, pool.negative, again,
                     true);
    EXPECT_TRUE(sameBits(phi, again));  // the flags of the first call stand
    double sum = 0;
    int cells = 0;
    forEachInner(pool.grid.cells, 0, [&](int i, int j, int k) {
      const double exact = pool.phi(i, j, k);
      if (std::abs(exact) > 0.5 * pool.grid.dx) return;
      sum += std::abs(phi(i, j, k) - exact) / pool.grid.dx;
      ++cells;
    });
    // Markers sample the distance with a gap of about 1/4 cell between them, and reach only as far as their
    // radius.
    EXPECT_LT(sum / cells, 0.25 * 0.6) << shift;
  }
}

TEST(AdjustRadii, GivesAnEscapedMarkerTheSmallestRadius) {
  Pool pool(16, flat);
  pool.negative.append(8, 9, 8, 0.5f);  // one cell above the surface
  pool.negative.append(8, 7.7f, 8, 0.5f);
  adjustRadii(pool.scene(), pool.phi, MarkerSign::negative, pool.negative);
  EXPECT_FLOAT_EQ(pool.negative.radius[0], 0.1f);
  EXPECT_EQ(pool.negative.escaped[0], 1);
  EXPECT_NEAR(pool.negative.radius[1], 0.3f, 1e-5);
  EXPECT_EQ(pool.negative.escaped[1], 0);
}

}  // namespace
}  // namespace spume::fluid
