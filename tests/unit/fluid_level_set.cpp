#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "fluid/level_set.h"
#include "fluid/plane_fraction.h"
#include "fluid/solid_extension.h"
#include "tests/support/fluid_fields.h"

namespace spume::fluid {
namespace {

using namespace test;
constexpr double kPi = std::numbers::pi;
/// Round-off of phi in float, relative to a cell, times the margin of a sum of plane cuts.
constexpr double kFloatCells = 1e-5;

double volumeOf(const GridSpec& grid, const DomainWalls& walls, const ScalarFunction& phi0,
                const std::vector<SolidObject>& objects = {}) {
  const SolidBoundary solids = buildSolidBoundary(grid, walls, objects, 0);
  return liquidVolume(grid, levelSet(grid, phi0), solids);
}

TEST(PlaneFraction, MatchesClosedForms) {
  EXPECT_NEAR(planeFraction(0.2, 1, 0, 0), 0.3, 1e-12);  // a slab
  EXPECT_NEAR(planeFraction(-0.2, 0, -1, 0), 0.7, 1e-12);
  EXPECT_NEAR(planeFraction(0, 1, 2, 3), 0.5, 1e-12);                          // through the centre
  EXPECT_NEAR(planeFraction(1.5 - 0.3, 1, 1, 1), 0.3 * 0.3 * 0.3 / 6, 1e-12);  // a corner tetrahedron
  EXPECT_NEAR(planeFraction(1 - 0.4, 1, 1, 0), 0.4 * 0.4 / 2, 1e-12);          // an edge prism
  EXPECT_EQ(planeFraction(-1e-9, 0, 0, 0), 1);
}

/// The same by exact integration along columns: off by the square of their width where the surface bends over
/// a cell's edge.
double fractionByColumns(double value, double gx, double gy, double gz) {
  constexpr int kColumns = 200;
  double sum = 0;
  for (int i = 0; i < kColumns; ++i)
    for (int j = 0; j < kColumns; ++j) {
      const double x = (i + 0.5) / kColumns - 0.5, y = (j + 0.5) / kColumns - 0.5;
      const double low = std::clamp(-(value + gx * x + gy * y) / gz, -0.5, 0.5);  // where the sign changes
      sum += gz > 0 ? low + 0.5 : 0.5 - low;
    }
  return sum / (kColumns * kColumns);
}

TEST(PlaneFraction, IsTheVolumeUnderAnyPlane) {
  std::mt19937 random(5);
  std::normal_distribution<double> slope;
  std::uniform_real_distribution<double> share(-0.5, 0.5);
  for (int n = 0; n < 100; ++n) {
    const double gx = slope(random) * (n % 3 == 0 ? 0.05 : 1), gy = slope(random) * (n % 5 == 0 ? 0.05 : 1);
    const double gz = slope(random), value = share(random) * (std::abs(gx) + std::abs(gy) + std::abs(gz));
    EXPECT_NEAR(planeFraction(value, gx, gy, gz), fractionByColumns(value, gx, gy, gz), 1e-4)
        << value << ' ' << gx << ' ' << gy << ' ' << gz;
  }
}

TEST(LiquidVolume, OfAFlatSurfaceIsExactAtAnyHeight) {
  const GridSpec grid = unitCube(16);
  for (const double height : {0.5, 0.5123, 0.53, 0.5311, 0.5624}) {
    const double volume = volumeOf(grid, closedWalls(), [&](const auto& x) { return x.y() - height; });
    EXPECT_NEAR(volume, height, kFloatCells * grid.dx);
  }
}

TEST(LiquidVolume, OfATiltedSurfaceIsExact) {
  const GridSpec grid = unitCube(16);
  const Eigen::Vector3d normal = Eigen::Vector3d(1, 2, 0.5).normalized();
  // The plane passes through the centre of the cube: half of it is liquid, except where the mirrored ghosts
  // turn the surface upright at the walls: half a cell on every side, where the excess cancels by symmetry.
  const double volume = volumeOf(
      grid, closedWalls(), [&](const auto& x) { return (x - Eigen::Vector3d::Constant(0.5)).dot(normal); });
  EXPECT_NEAR(volume, 0.5, kFloatCells);
}

TEST(LiquidVolume, OfASphereConvergesFasterThanSecondOrder) {
  const double radius = 0.3137, exact = 4 * kPi / 3 * std::pow(radius, 3);
  double error[2];
  for (const int level : {0, 1}) {
    const GridSpec grid = unitCube(16 << level);
    error[level] = std::abs(
        volumeOf(grid, closedWalls(),
                 [&](const auto& x) { return (x - Eigen::Vector3d(0.48, 0.51, 0.503)).norm() - radius; }) /
            exact -
        1);
  }
  EXPECT_LT(error[0], 1e-3);  // 5 cells radius: the next curvature term, (dx/R)^4, with room for the limiter
  EXPECT_LT(error[1], std::max(error[0] / 5, 2e-5));
}

TEST(LiquidVolume, OfABallCutByAWallIsHalf) {
  const double radius = 0.3;
  const GridSpec grid = unitCube(32);
  const double volume = volumeOf(
      grid, closedWalls(), [&](const auto& x) { return (x - Eigen::Vector3d(0.5, 0, 0.5)).norm() - radius; });
  EXPECT_NEAR(volume / (2 * kPi / 3 * std::pow(radius, 3)), 1, 2e-4);  // as for the whole sphere
}

TEST(LiquidVolume, OfAPoolOverASubCellFloorCountsTheFreeSpaceOnly) {
  const GridSpec grid = unitCube(16);
  const double floor = 0.2013, height = 0.6117;
  const SolidObject slab{"slab", [=](const Eigen::Vector3d& x, double) { return x.y() - floor; }, {}, false};
  const double volume = volumeOf(grid, closedWalls(), [&](const auto& x) { return x.y() - height; }, {slab});
  EXPECT_NEAR(volume, height - floor, 1e-4 * grid.dx * 16);  // face fractions of the floor in float
}

TEST(GhostLayers, ReflectPhiAndRepeatVelocity) {
  const GridSpec grid = unitCube(8);
  const DenseField<float> phi =
      levelSet(grid, [](const auto& x) { return 0.1 * x.x() + 0.2 * x.y() - 0.3 * x.z(); });
  EXPECT_EQ(phi(-1, 3, 4), phi(0, 3, 4));
  EXPECT_EQ(phi(-4, -2, 9), phi(3, 1, 6));
  EXPECT_EQ(phi(11, 3, 4), phi(4, 3, 4));
  const MacVelocity u = macField(grid, [](const auto& x) { return x; });
  EXPECT_EQ(u[0](-2, 3, 4), u[0](0, 3, 4));
  EXPECT_EQ(u[0](12, 3, 4), u[0](8, 3, 4));
}

/// A surface at rest must not bend at a sloped wall: behind it a level field has the values of its levels, to
/// the bit.
TEST(SolidExtension, ContinuesALevelFieldExactlyThroughASlopedWall) {
  const GridSpec grid = unitCube(16);
  const Eigen::Vector3d normal = Eigen::Vector3d(1, 0.4, 0.2).normalized();
  const SolidObject slope{
      "slope", [=](const Eigen::Vector3d& x, double) { return normal.dot(x) - 0.551; }, {}, false};
  const SolidBoundary solids = buildSolidBoundary(grid, openWalls(), {slope}, 0);
  SolidExtension extension;
  extension.rebuild(solids);
  const DenseField<float> level = levelSet(grid, [](const Eigen::Vector3d& x) { return x.y() - 0.4; });
  DenseField<float> phi = level;
  int behind = 0;
  forEachInner(grid.cells, 0, [&](int i, int j, int k) {
    if (solids.psi(i, j, k) <= 0) phi(i, j, k) = 0.77f;
  });
  extension.apply(phi);
  forEachInner(grid.cells, 2, [&](int i, int j, int k) {
    if (solids.psi(i, j, k) > 0 || solids.psi(i, j, k) < -grid.dx) return;
    EXPECT_EQ(phi(i, j, k), level(i, j, k));
    ++behind;
  });
  EXPECT_GT(behind, 100);
}

TEST(SolidExtension, ContinuesTheSlopeIntoAFloor) {
  const GridSpec grid = unitCube(16);
  const SolidObject floor{"floor", [](const Eigen::Vector3d& x, double) { return x.y() - 0.33; }, {}, false};
  const SolidBoundary solids = buildSolidBoundary(grid, openWalls(), {floor}, 0);
  SolidExtension extension;
  extension.rebuild(solids);
  const DenseField<float> level = levelSet(grid, [](const Eigen::Vector3d& x) { return x.y() - 0.35; });
  DenseField<float> phi = level;
  for (const int j : {3, 4}) phi(8, j, 8) = 0.77f;
  extension.apply(phi);
  for (const int j : {3, 4}) EXPECT_NEAR(phi(8, j, 8), level(8, j, 8), 1e-6) << j;
}

/// A surface that sinks away under liquid: on the floor's side of it gravity says whether air can be there.
TEST(SolidExtension, LiquidOnAFloorHasNoAirBelowItButMayUnderALid) {
  const GridSpec grid = unitCube(16);
  const SolidObject floor{"floor", [](const Eigen::Vector3d& x, double) { return x.y() - 0.33; }, {}, false};
  SolidBoundary solids = buildSolidBoundary(grid, openWalls(), {floor}, 0);
  const DenseField<float> level = levelSet(grid, [](const Eigen::Vector3d& x) { return 0.32 - x.y(); });
  ASSERT_LT(level(8, 5, 8), 0);
  ASSERT_GT(level(8, 4, 8), 0);
  SolidExtension extension;
  for (const int upSense : {1, 0, -1}) {
    solids.sides.upSense = upSense;
    extension.rebuild(solids);
    DenseField<float> phi = level;
    extension.apply(phi);
    for (const int j : {3, 4})
      EXPECT_NEAR(phi(8, j, 8), upSense > 0 ? level(8, 5, 8) : level(8, j, 8), 1e-6) << upSense;
  }
}

}  // namespace
}  // namespace spume::fluid
