#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "fluid/connected_cells.h"
#include "fluid/solid_boundary.h"
#include "tests/fluid_scenery.h"

namespace spume::fluid {
namespace {

using namespace testing;

TEST(SolidBoundary, DomainWallsCloseTheirFacesOnly) {
  const GridSpec grid = boxGrid(8);
  const SolidBoundary boundary = buildSolidBoundary(grid, DomainWalls{}, {}, 0);  // open at +y
  forEachFace(grid, [&](int a, const Eigen::Vector3i& c) {
    const bool closed = c[a] == 0 || (c[a] == 8 && a != 1);
    EXPECT_EQ(boundary.open[a](c), closed ? 0 : 1);
  });
  EXPECT_FLOAT_EQ(boundary.psi(0, 3, 3), static_cast<float>(0.5 * grid.dx));
  EXPECT_EQ(boundary.object(0, 3, 3), -1);
}

/// The cut of a sphere through the faces of one plane of the grid is a disc: its area is known.
TEST(SolidBoundary, FacesOfAPlaneCutASphereInItsDisc) {
  const GridSpec grid = boxGrid(64);
  const Eigen::Vector3d centre(0.0813, 0.0791, 0.0777);
  const double radius = 0.04;
  const SolidBoundary boundary = buildSolidBoundary(grid, DomainWalls{}, {sphere(centre, radius)}, 0);
  for (int a = 0; a < 3; ++a)
    for (int n : {20, 32, 40}) {
      double covered = 0;
      forEachFace(grid, [&](int axis, const Eigen::Vector3i& c) {
        if (axis == a && c[a] == n) covered += (1 - boundary.open[a](c)) * grid.dx * grid.dx;
      });
      const double offset = n * grid.dx - centre[a];
      const double disc = std::numbers::pi * (radius * radius - offset * offset);
      // Linear interpolation moves the circle of radius R by up to dx^2/8R, chords by dx^2/12R: area by <
      // (dx/R)^2/2.
      const double error = 0.5 * grid.dx * grid.dx * std::numbers::pi;
      EXPECT_NEAR(covered, disc, error) << "axis " << a << " plane " << n;
    }
}

TEST(SolidBoundary, CellsHoldTheSphereVolume) {
  const GridSpec grid = boxGrid(64);
  const double radius = 0.04;
  const SolidBoundary boundary =
      buildSolidBoundary(grid, DomainWalls{}, {sphere({0.0813, 0.0791, 0.0777}, radius)}, 0);
  double solid = 0;
  for (int i = 0; i < 64; ++i)
    for (int j = 0; j < 64; ++j)
      for (int k = 0; k < 64; ++k) solid += (1 - boundary.cellFraction(i, j, k)) * grid.cellVolume();
  // Flat pieces of edge dx inside a sphere of 16 dx: relative error (dx/R)^2/2 at most; closed slivers add
  // less.
  EXPECT_NEAR(solid / (4 * std::numbers::pi / 3 * std::pow(radius, 3)), 1, 0.75 / 256);
}

TEST(SolidBoundary, AWallOneCellThickLeaksNowhere) {
  const GridSpec grid = boxGrid(24);
  for (int n = 0; n < 20; ++n) {
    const Eigen::Vector3d centre =
        Eigen::Vector3d(0.08, 0.08, 0.08) + grid.dx * n / 20.0 * Eigen::Vector3d(1, 0.37, 0.61);
    const double thickness = grid.dx;
    const SolidObject shell{"shell",
                            [=](const Eigen::Vector3d& x, double) {
                              return std::abs((x - centre).norm() - 0.04) - 0.5 * thickness;
                            },
                            {},
                            false};
    const SolidBoundary boundary = buildSolidBoundary(grid, DomainWalls{}, {shell}, 0);
    ConnectedCells connected;
    DenseField<std::int32_t> label;
    connected.label(
        grid.cells, [&](int i, int j, int k) { return boundary.hasOpenFace(i, j, k); },
        [&](int a, int i, int j, int k) { return boundary.open[a](i, j, k) > 0; }, label);
    const Eigen::Vector3i inside = grid.toCells(centre).cast<int>();
    EXPECT_GE(label(inside), 0);
    EXPECT_NE(label(inside), label(0, 0, 0)) << n;
  }
}

TEST(SolidBoundary, ABoxFlushWithTheGridClosesItsOwnFacesOnly) {
  const GridSpec grid = boxGrid(16);
  const Eigen::Vector3d low = Eigen::Vector3d::Constant(4 * grid.dx),
                        high = Eigen::Vector3d::Constant(8 * grid.dx);
  const SolidObject box{"box",
                        [=](const Eigen::Vector3d& x, double) {
                          const Eigen::Vector3d q = (x - 0.5 * (low + high)).cwiseAbs() - 0.5 * (high - low);
                          return q.cwiseMax(0).norm() + std::min(q.maxCoeff(), 0.0);
                        },
                        {},
                        false};
  const SolidBoundary boundary = buildSolidBoundary(grid, DomainWalls{}, {box}, 0);
  EXPECT_EQ(boundary.open[0](4, 5, 5), 0);  // on its surface
  EXPECT_EQ(boundary.open[0](8, 5, 5), 0);
  EXPECT_EQ(boundary.open[0](3, 5, 5), 1);
  EXPECT_EQ(boundary.open[0](9, 5, 5), 1);
  EXPECT_NEAR(boundary.open[1](3, 5, 5), 1, 1e-5);  // beside it; corners are snapped by 1e-6 dx
  EXPECT_EQ(boundary.cellFraction(5, 5, 5), 0);
}

TEST(SolidBoundary, AMovingSolidUpdatesLikeAFreshBuild) {
  const GridSpec grid = boxGrid(16);
  const Eigen::Vector3d speed(0.1, -0.2, 0.05);
  SolidObject moving{"ball",
                     [=](const Eigen::Vector3d& x, double t) {
                       return (x - Eigen::Vector3d(0.08, 0.1, 0.08) - t * speed).norm() - 0.03;
                     },
                     [=](const Eigen::Vector3d&, double) { return speed; }, true};
  const std::vector<SolidObject> solids{sphere({0.03, 0.03, 0.03}, 0.02), moving};
  SolidBoundary updated = buildSolidBoundary(grid, DomainWalls{}, solids, 0);
  updateSolidBoundary(grid, DomainWalls{}, solids, 0.2, updated);
  const SolidBoundary fresh = buildSolidBoundary(grid, DomainWalls{}, solids, 0.2);
  int moved = 0;
  forEachFace(grid, [&](int a, const Eigen::Vector3i& c) {
    EXPECT_EQ(updated.open[a](c), fresh.open[a](c));
    EXPECT_EQ(updated.velocity[a](c), fresh.velocity[a](c));
    if (updated.velocity[a](c) == 0) return;
    EXPECT_FLOAT_EQ(updated.velocity[a](c), static_cast<float>(speed[a]));
    ++moved;
  });
  EXPECT_GT(moved, 0);
}

}  // namespace
}  // namespace spume::fluid
