#include <gtest/gtest.h>
#include <openvdb/tools/Diagnostics.h>

#include <cmath>
#include <cstdio>

#include "coupling/liquid_cache.h"
#include "coupling/vdb_file.h"
#include "fluid/parallel.h"
#include "tests/support/temporary_path.h"

namespace spume::coupling {
namespace {

constexpr double kVoxel = 2.5e-3;
constexpr int kCells = 40;
// Of the glass [voxels]: inner radius, depth, thickness of its wall.
constexpr double kInner = 8.3, kDepth = 20.6, kWall = 1.5;

/// Place of a cell's centre in the glass: x away from its axis, y along it from the inner bottom [voxels].
Eigen::Vector2d inGlass(double tilt, const Eigen::Vector3d& cell) {
  const Eigen::Vector3d axis(std::sin(tilt), std::cos(tilt), 0), from = cell - Eigen::Vector3d(14, 11, 20);
  const double along = from.dot(axis);
  return {(from - along * axis).norm(), along};
}

/// Water up to a level in a tilted glass, cut off at its mouth, drops on its outer face, and nothing else.
fluid::LiquidState water(double tilt, double level, fluid::SolidBoundary& solids) {
  fluid::LiquidState liquid;
  liquid.grid = {Eigen::Vector3i::Constant(kCells), kVoxel, {0, 0, 0}};
  liquid.phi = fluid::DenseField<float>(liquid.grid.cells);
  liquid.velocity = fluid::MacVelocity(liquid.grid.cells, 0.0f);
  solids.psi = fluid::DenseField<float>(liquid.grid.cells);
  fluid::forEachCell(liquid.grid.cells, [&](int i, int j, int k) {
    const Eigen::Vector3d cell(i + 0.5, j + 0.5, k + 0.5);
    const Eigen::Vector2d at = inGlass(tilt, cell);
    const double room = std::max(at.x() - kInner, -at.y());
    const double outside = std::max({at.x() - kInner - kWall, -kWall - at.y(), at.y() - kDepth});
    solids.psi(i, j, k) = static_cast<float>(kVoxel * std::max(outside, -std::max(room, at.y() - kDepth)));
    const bool inside = room < 0.5 * kWall;
    double phi = inside ? std::max(cell.y() - level, at.y() - kDepth) : 10;
    for (int n = 0; n < 12 && !inside; ++n) {
      const double turn = 2.4 * n;
      const Eigen::Vector3d drop(14 + 10.4 * std::cos(turn), 10 + 2.3 * n, 20 + 10.4 * std::sin(turn));
      phi = std::min(phi, (cell - drop).norm() - 0.7 - 0.2 * n);
    }
    liquid.phi(i, j, k) = static_cast<float>(kVoxel * phi);
  });
  return liquid;
}

class GlassOfWater : public ::testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Tilts, GlassOfWater, ::testing::Values(0.0, 0.3, 0.8, 1.3));

/// Sharp edges all along the glass, drops finer than a voxel on it, and still a level set to other programs.
TEST_P(GlassOfWater, IsWrittenAsALevelSetThatPassesTheCheckOfOpenVdb) {
  const std::string path = temporaryPath("glass.vdb");
  for (const double level : {14.2, 20.5, 25.8}) {
    fluid::SolidBoundary solids;
    writeLiquidFrame(path, water(GetParam(), level, solids), solids, {1, 0, 30}, {});
    const auto surface = findGrid<openvdb::FloatGrid>(readVdb(path), "surface");
    ASSERT_TRUE(surface);
    EXPECT_EQ(openvdb::tools::checkLevelSet(*surface), "") << level;
  }
  std::remove(path.c_str());
}

/// Making it a distance near solids again leaves the free surface where it is: in place to a tenth of a voxel
/// two voxels from the glass, and untouched farther away.
TEST_P(GlassOfWater, KeepsItsFreeSurface) {
  const std::string path = temporaryPath("glass_surface.vdb");
  constexpr double kLevel = 20.5;
  fluid::SolidBoundary solids;
  const fluid::LiquidState liquid = water(GetParam(), kLevel, solids);
  writeLiquidFrame(path, liquid, solids, {1, 0, 30}, {});
  const fluid::DenseField<float> phi = readLiquidFrame(path).liquid.phi;
  std::remove(path.c_str());
  int seen = 0;
  for (int i = 0; i < kCells; ++i)
    for (int k = 0; k < kCells; ++k) {
      const Eigen::Vector2d at = inGlass(GetParam(), {i + 0.5, kLevel, k + 0.5});
      const double toGlass = std::min(kInner - at.x(), at.y());
      if (toGlass < 2 || at.y() > kDepth - 2) continue;
      const int j = static_cast<int>(kLevel);
      EXPECT_NEAR(phi(i, j, k), liquid.phi(i, j, k), (toGlass > 4.5 ? 0 : 0.1) * kVoxel) << i << " " << k;
      ++seen;
    }
  EXPECT_GT(seen, 20);
}

}  // namespace
}  // namespace spume::coupling
