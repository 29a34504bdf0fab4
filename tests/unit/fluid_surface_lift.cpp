#include <gtest/gtest.h>

#include <algorithm>

#include "fluid/level_set.h"
#include "fluid/surface_lift.h"
#include "tests/support/fluid_fields.h"

namespace spume::fluid {
namespace {

using namespace test;

constexpr int kCells = 24;
constexpr double kHeight = 0.43;  // [m]

/// A pool in a closed cube of 1 m.
struct Pool {
  GridSpec grid = unitCube(kCells);
  std::vector<SolidObject> objects;
  SolidBoundary solids;
  DenseField<float> phi{grid.cells};
  MarkerSet positive, negative;
  SurfaceLift lift{grid};

  explicit Pool(std::vector<SolidObject> o = {})
      : objects(std::move(o)), solids(buildSolidBoundary(grid, closedWalls(), objects, 0)) {
    if (!objects.empty()) solids.sides.find(solids);
    initialiseLevelSet(
        grid, [](const Eigen::Vector3d& x) { return x.y() - kHeight; }, phi);
  }

  double volume() const { return liquidVolume(grid, phi, solids) / grid.cellVolume(); }
  double raise(const std::vector<CrowdedCell>& crowded) {
    const double before = volume();
    lift.apply(crowded, solids, phi, positive, negative);
    return volume() - before;
  }
  static constexpr double toCells(double x) { return x * kCells; }
};

TEST(SurfaceLift, TheSurfaceRisesByTheCrowdedVolume) {
  Pool pool;
  const float before = pool.phi(12, 9, 12), far = pool.phi(2, 9, 2);
  const double risen = pool.raise({{{12, 7, 12}, 1.5f}, {{12, 8, 13}, 0.5f}});
  EXPECT_NEAR(risen, 2, 0.1);  // lifts below kLeast are left
  EXPECT_LT(pool.phi(12, 9, 12), before);
  EXPECT_EQ(pool.phi(2, 9, 2), far);
}

TEST(SurfaceLift, ItFallsByWhatIsShownTooMuch) {
  Pool pool;
  EXPECT_NEAR(pool.raise({{{12, 9, 12}, -2.0f}}), -2, 0.1);
}

TEST(SurfaceLift, MarkersGoWithTheSurface) {
  Pool pool;
  const float surface = static_cast<float>(Pool::toCells(kHeight));
  pool.positive.append(12.5f, surface + 0.05f, 12.5f, 0.1f);
  pool.positive.append(2.5f, surface + 0.05f, 2.5f, 0.1f);
  pool.negative.append(12.5f, surface - 0.05f, 12.5f, 0.1f);
  pool.raise({{{12, 9, 12}, 4.0f}});
  const float moved = pool.positive.y[0] - surface - 0.05f;
  EXPECT_GT(moved, 0.05f);
  EXPECT_NEAR(pool.negative.y[0], surface - 0.05f + moved, 1e-5f);
  EXPECT_EQ(pool.positive.y[1], surface + 0.05f);
  EXPECT_NEAR(pool.positive.x[0], 12.5f, 1e-5f);
}

/// No surface moves by more than half a cell in a step, whatever is asked of it.
TEST(SurfaceLift, IsHalfACellAtMost) {
  Pool pool;
  const DenseField<float> before = pool.phi;
  pool.raise({{{12, 9, 12}, 1000.0f}});
  float most = 0;
  for (int j = 0; j < kCells; ++j) most = std::max(most, before(12, j, 12) - pool.phi(12, j, 12));
  EXPECT_NEAR(most, 0.5 * pool.grid.dx, 1e-6);
}

/// A wall of one cell between two pools: what is crowded on its one side comes up there.
TEST(SurfaceLift, StaysOnItsSideOfAThinWall) {
  const double low = 0.5, high = low + 1.0 / kCells;
  Pool pool(
      {{"wall", [=](const Eigen::Vector3d& x, double) { return std::max(low - x.x(), x.x() - high); }, {}}});
  const DenseField<float> before = pool.phi;
  EXPECT_GT(pool.raise({{{11, 8, 12}, 2.0f}}), 1);
  for (int i = 13; i < kCells; ++i)
    for (int j = 0; j < kCells; ++j)
      for (int k = 0; k < kCells; ++k) ASSERT_EQ(pool.phi(i, j, k), before(i, j, k));
}

}  // namespace
}  // namespace spume::fluid
