#include <gtest/gtest.h>
#include <openvdb/tools/Diagnostics.h>
#include <openvdb/tools/LevelSetMeasure.h>

#include <cmath>
#include <functional>

#include "fluid/level_set.h"
#include "fluid/reinitialize.h"
#include "fluid/vdb_grids.h"

namespace spume::fluid {
namespace {

const GridSpec kGrid{{24, 20, 16}, 0.01, {-0.1, 0.2, 0.3}};

LiquidState liquidOf(const std::function<double(const Eigen::Vector3d&)>& distance) {
  openvdb::initialize();
  LiquidState liquid;
  liquid.grid = kGrid;
  liquid.phi = DenseField<float>(kGrid.cells);
  liquid.velocity = MacVelocity(kGrid.cells);
  for (int i = 0; i < kGrid.cells.x(); ++i)
    for (int j = 0; j < kGrid.cells.y(); ++j)
      for (int k = 0; k < kGrid.cells.z(); ++k)
        liquid.phi(i, j, k) = static_cast<float>(distance(kGrid.cellCentre(i, j, k)));
  for (int axis = 0; axis < 3; ++axis) {
    auto& faces = liquid.velocity[axis];
    for (int i = 0; i < faces.size().x(); ++i)
      for (int j = 0; j < faces.size().y(); ++j)
        for (int k = 0; k < faces.size().z(); ++k) {
          const Eigen::Vector3d x = kGrid.faceCentre(axis, i, j, k);
          faces(i, j, k) = static_cast<float>(x[axis] + 2 * x[(axis + 1) % 3]);
        }
  }
  return liquid;
}

double pool(const Eigen::Vector3d& x) { return x.y() - 0.3137; }
double drop(const Eigen::Vector3d& x) { return (x - Eigen::Vector3d(0.02, 0.3, 0.38)).norm() - 0.043; }
double tilted(const Eigen::Vector3d& x) {
  return (x - Eigen::Vector3d(0, 0.3, 0.4)).dot(Eigen::Vector3d(0.36, 0.8, 0.48));
}

TEST(VdbGrids, SurfacePassesTheLevelSetCheck) {
  for (const auto& distance : {pool, drop, tilted}) {
    const auto surface = surfaceGrid(kGrid, liquidOf(distance).phi);
    EXPECT_EQ(surface->getGridClass(), openvdb::GRID_LEVEL_SET);
    EXPECT_EQ(openvdb::tools::checkLevelSet(*surface), "");
  }
}

/// Drops and pits of every size down to a fraction of a cell, anywhere, also cut by the walls.
double rough(const Eigen::Vector3d& x) {
  double phi = x.y() - 0.3 - 0.03 * std::sin(90 * x.x()) * std::cos(70 * x.z());
  for (int n = 0; n < 60; ++n) {
    const Eigen::Vector3d centre(-0.1 + 0.24 * std::fmod(n * 0.618034, 1),
                                 0.2 + 0.2 * std::fmod(n * 0.754878, 1),
                                 0.3 + 0.16 * std::fmod(n * 0.569840, 1));
    const double radius = 0.001 + 0.012 * std::fmod(n * 0.3819, 1);
    const double sphere = (x - centre).norm() - radius;
    phi = n % 2 ? std::min(phi, sphere) : std::max(phi, -sphere);
  }
  return phi;
}

TEST(VdbGrids, TurbulentSurfacePassesTheLevelSetCheck) {
  LiquidState liquid = liquidOf(rough);
  fillGhostLayers(liquid.phi);
  Reinitializer(kGrid).apply(liquid.phi);
  EXPECT_EQ(openvdb::tools::checkLevelSet(*surfaceGrid(kGrid, liquid.phi)), "");
}

TEST(VdbGrids, ClosedSurfaceEnclosesTheVolumeOfThePool) {
  const auto surface = surfaceGrid(kGrid, liquidOf(pool).phi);
  const Eigen::Vector3d size = kGrid.dx * kGrid.cells.cast<double>();
  const double exact = size.x() * size.z() * (0.3137 - kGrid.origin.y());
  constexpr double kSmearing =
      0.02;  // the measure smooths the surface over 1.5 cells; it errs at edges and corners
  EXPECT_NEAR(openvdb::tools::levelSetVolume(*surface), exact, kSmearing * exact);
}

TEST(VdbGrids, VoxelsLieAtTheCellCentres) {
  const auto surface = surfaceGrid(kGrid, liquidOf(drop).phi);
  const openvdb::Vec3d at = surface->indexToWorld(openvdb::Coord(3, 5, 7));
  const Eigen::Vector3d expected = kGrid.cellCentre(3, 5, 7);
  constexpr double kRoundOff = 1e-15;
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(at[axis], expected[axis], kRoundOff);
  EXPECT_EQ(surface->voxelSize().x(), kGrid.dx);
  EXPECT_FALSE(surface->saveFloatAsHalf());
}

TEST(VdbGrids, GridSpecReadsBack) {
  const GridSpec spec = gridSpecOf(*surfaceGrid(kGrid, liquidOf(drop).phi));
  EXPECT_EQ(spec.cells, kGrid.cells);
  EXPECT_EQ(spec.origin, kGrid.origin);
  EXPECT_EQ(spec.dx, kGrid.dx);
  EXPECT_THROW(gridSpecOf(*openvdb::FloatGrid::create()), std::invalid_argument);
}

/// Largest |a - b| over all cells, b clamped to the band.
double largestPhiError(const DenseField<float>& a, const DenseField<float>& b) {
  const float band = std::nextafter(static_cast<float>(kSurfaceBand * kGrid.dx), 1.0f);
  double worst = 0;
  for (int i = 0; i < kGrid.cells.x(); ++i)
    for (int j = 0; j < kGrid.cells.y(); ++j)
      for (int k = 0; k < kGrid.cells.z(); ++k)
        worst = std::max(worst, double(std::abs(a(i, j, k) - std::clamp(b(i, j, k), -band, band))));
  return worst;
}

TEST(VdbGrids, PhiReadsBackUpToTheWalls) {
  for (const auto& distance : {pool, drop}) {
    const LiquidState liquid = liquidOf(distance);
    EXPECT_EQ(largestPhiError(phiFrom(*surfaceGrid(kGrid, liquid.phi)), liquid.phi), 0);
  }
}

TEST(VdbGrids, StaggeredVelocityReadsBackExactlyInTheBand) {
  const LiquidState liquid = liquidOf(pool);
  const auto grid = velocityGrid(liquid, true);
  EXPECT_EQ(grid->getGridClass(), openvdb::GRID_STAGGERED);
  const MacVelocity read = velocityFrom(*grid);
  for (int axis = 0; axis < 3; ++axis)
    for (int i = 0; i < read[axis].size().x(); ++i)
      for (int k = 0; k < read[axis].size().z(); ++k)
        for (int j = 0; j < 12; ++j)  // 11.37 cells of water
          EXPECT_EQ(read[axis](i, j, k), liquid.velocity[axis](i, j, k))
              << axis << ": " << i << ' ' << j << ' ' << k;
}

TEST(VdbGrids, CentredVelocityIsTheMeanOfTheFaces) {
  const LiquidState liquid = liquidOf(pool);
  const auto grid = velocityGrid(liquid, false);
  constexpr double kFloatError = 1e-7;
  for (const auto& [i, j, k] : {std::array{0, 0, 0}, {5, 7, 9}, {23, 11, 15}}) {
    const openvdb::Vec3s value = grid->tree().getValue({i, j, k});
    const Eigen::Vector3d x = kGrid.cellCentre(i, j, k);
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(value[axis], x[axis] + 2 * x[(axis + 1) % 3], kFloatError);
  }
  EXPECT_FALSE(grid->tree().isValueOn({5, 19, 5}));
}

TEST(VdbGrids, SolidReadsBackExactly) {
  const LiquidState liquid = liquidOf(drop);
  const DenseField<float> psi = psiFrom(*solidGrid(kGrid, liquid.phi));
  for (int i = 0; i < kGrid.cells.x(); ++i)
    for (int j = 0; j < kGrid.cells.y(); ++j)
      for (int k = 0; k < kGrid.cells.z(); ++k) EXPECT_EQ(psi(i, j, k), liquid.phi(i, j, k));
}

TEST(VdbGrids, EmptyAndFullDomainsAreLevelSetsToo) {
  const auto empty = surfaceGrid(kGrid, liquidOf([](const auto&) { return 1.0; }).phi);
  EXPECT_EQ(empty->activeVoxelCount(), 0u);
  const auto full = surfaceGrid(kGrid, liquidOf([](const auto&) { return -1.0; }).phi);
  EXPECT_EQ(openvdb::tools::checkLevelSet(*full), "");
}

}  // namespace
}  // namespace spume::fluid
