#include <gtest/gtest.h>

#include "fluid/reinitialize.h"
#include "fluid/solid_extension.h"
#include "tests/support/fluid_fields.h"

namespace spume::fluid {
namespace {

using namespace test;

const Eigen::Vector3d kCentre(0.503, 0.491, 0.512);
double sphere(const Eigen::Vector3d& x) { return (x - kCentre).norm() - 0.3; }

/// Largest distance error [cells] where the exact distance is below `reach` cells.
double worstError(const GridSpec& grid, const DenseField<float>& phi, const ScalarFunction& exact,
                  double reach) {
  double worst = 0;
  forEachInner(grid.cells, 0, [&](int i, int j, int k) {
    const double d = exact(grid.cellCentre(i, j, k)) / grid.dx;
    if (std::abs(d) < reach) worst = std::max(worst, std::abs(phi(i, j, k) / grid.dx - d));
  });
  return worst;
}

/// Largest | |grad phi| - 1 | by central differences within `reach` cells of the surface.
double worstSlope(const GridSpec& grid, const DenseField<float>& phi, double reach) {
  double worst = 0;
  forEachInner(grid.cells, 1, [&](int i, int j, int k) {
    if (std::abs(phi(i, j, k)) > reach * grid.dx) return;
    const Eigen::Vector3d g(phi(i + 1, j, k) - phi(i - 1, j, k), phi(i, j + 1, k) - phi(i, j - 1, k),
                            phi(i, j, k + 1) - phi(i, j, k - 1));
    worst = std::max(worst, std::abs(g.norm() / (2 * grid.dx) - 1));
  });
  return worst;
}

TEST(Reinitializer, FiftyRoundsLeaveASphereWhereItIs) {
  const GridSpec grid = unitCube(48);
  DenseField<float> phi = levelSet(grid, sphere);
  Reinitializer reinitializer(grid);
  for (int round = 0; round < 50; ++round) reinitializer.apply(phi);
  EXPECT_LT(worstError(grid, phi, sphere, 1), 0.02);  // aim of case L9
  EXPECT_LT(worstSlope(grid, phi, kLevelSetBand - 1), 0.02);
}

TEST(Reinitializer, TurnsADistortedFunctionIntoTheDistanceAtOnce) {
  const GridSpec grid = unitCube(48);
  DenseField<float> phi = levelSet(grid, [](const Eigen::Vector3d& x) {
    return sphere(x) * (1 + 0.5 * std::sin(8 * x.x()) * std::cos(6 * x.y()));
  });
  Reinitializer(grid).apply(phi);
  // Cubic interpolation of a factor with wave number k = 8: (k dx)^4/24 = 3e-5 per unit of a distance of a
  // few cells.
  EXPECT_LT(worstError(grid, phi, sphere, 1), 0.005);
  EXPECT_LT(worstError(grid, phi, sphere, kLevelSetBand - 0.5), 0.03);
}

TEST(Reinitializer, KeepsAPlaneToRoundOff) {
  const GridSpec grid = unitCube(24);
  const Eigen::Vector3d normal = Eigen::Vector3d(0.2, 1, -0.4).normalized();
  const auto plane = [&](const Eigen::Vector3d& x) {
    return (x - Eigen::Vector3d::Constant(0.51)).dot(normal);
  };
  DenseField<float> phi = levelSet(grid, plane);
  Reinitializer(grid).apply(phi);
  double worst = 0;
  // Mirrored ghosts bend the surface at the walls; away from them it is a plane.
  forEachInner(grid.cells, 8, [&](int i, int j, int k) {
    const double d = plane(grid.cellCentre(i, j, k));
    if (std::abs(d) < 4 * grid.dx) worst = std::max(worst, std::abs(phi(i, j, k) - d) / grid.dx);
  });
  EXPECT_LT(worst, 1e-4);  // Newton's stopping distance
}

TEST(Reinitializer, KeepsAFilmOneCellThick) {
  const GridSpec grid = unitCube(24);
  // Centred on a layer of cells: elsewhere one value per cell cannot hold both faces of so thin a film.
  const double middle = 12.5 * grid.dx, half = 0.6 * grid.dx;
  const auto film = [&](const Eigen::Vector3d& x) { return std::abs(x.y() - middle) - half; };
  DenseField<float> phi = levelSet(grid, film);
  Reinitializer reinitializer(grid);
  for (int round = 0; round < 20; ++round) reinitializer.apply(phi);
  EXPECT_LT(worstError(grid, phi, film, 1), 1e-3);
}

TEST(Reinitializer, KeepsSignsAndClampsTheFarField) {
  const GridSpec grid = unitCube(32);
  const DenseField<float> before = levelSet(grid, [](const auto& x) { return x.y() - 0.31; });
  DenseField<float> phi = before;
  Reinitializer(grid).apply(phi);
  const float band = kLevelSetBand * static_cast<float>(grid.dx);
  forEachInner(grid.cells, 0, [&](int i, int j, int k) {
    EXPECT_EQ(phi(i, j, k) < 0, before(i, j, k) < 0);
    EXPECT_LE(std::abs(phi(i, j, k)), band);
  });
  EXPECT_EQ(phi(3, 31, 3), band);
  EXPECT_EQ(phi(3, 0, 3), -band);
}

TEST(Reinitializer, GivesTheSameBitsOnAnyNumberOfThreads) {
  const GridSpec grid = unitCube(32);
  const auto run = [&](int threads) {
    return onThreads(threads, [&] {
      DenseField<float> phi = levelSet(grid, [](const auto& x) { return sphere(x) * (1 + 0.3 * x.x()); });
      Reinitializer reinitializer(grid);
      for (int round = 0; round < 3; ++round) reinitializer.apply(phi);
      return phi;
    });
  };
  EXPECT_TRUE(sameBits(run(1), run(4)));
}

TEST(Reinitializer, CarriesNoDistanceThroughASolid) {
  const GridSpec grid = unitCube(32);
  // A wall two cells thick parts a wet half from a dry one.
  const SolidObject wall{
      "wall",
      [&](const Eigen::Vector3d& x, double) { return std::abs(x.x() - 0.5) - 2 * grid.dx; },
      {},
      false};
  const SolidBoundary solids = buildSolidBoundary(grid, openWalls(), {wall}, 0);
  SolidExtension extension;
  extension.rebuild(solids);
  DenseField<float> phi = levelSet(grid, [](const auto& x) { return x.x() < 0.5 ? -1.0 : 1.0; });
  extension.apply(phi);
  Reinitializer(grid).apply(phi, &solids);
  EXPECT_EQ(phi(13, 16, 16), -kLevelSetBand * static_cast<float>(grid.dx));
  EXPECT_EQ(phi(18, 16, 16), kLevelSetBand * static_cast<float>(grid.dx));
}

}  // namespace
}  // namespace spume::fluid
