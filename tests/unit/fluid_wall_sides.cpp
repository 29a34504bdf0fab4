#include <gtest/gtest.h>

#include <cmath>

#include "fluid/solid_boundary.h"
#include "fluid/wall_sides.h"
#include "tests/support/fluid_fields.h"

namespace spume::fluid {
namespace {

using namespace test;

/// A wall across x that is `cells` thick, its left face at x [cells], up to a height [cells].
SolidBoundary wallAcrossX(const GridSpec& grid, double left, double cells, double height = 1e9) {
  const SolidObject wall{"wall",
                         [=](const Eigen::Vector3d& x, double) {
                           const double middle = (left + 0.5 * cells) * grid.dx;
                           return std::max(std::abs(x.x() - middle) - 0.5 * cells * grid.dx,
                                           x.y() - height * grid.dx);
                         },
                         {},
                         false};
  return buildSolidBoundary(grid, openWalls(), {wall}, 0);
}

TEST(WallSides, NoCellSeesThroughAWallOneCellThick) {
  const GridSpec grid = unitCube(16);
  for (const double left : {7.0, 7.2, 7.49, 7.5, 7.51, 7.8}) {
    const SolidBoundary solids = wallAcrossX(grid, left, 1);
    EXPECT_TRUE(solids.sides.any());
    forEachInner(grid.cells, 1, [&](int i, int j, int k) {
      const Eigen::Vector3i c(i, j, k);
      if (!solids.hasOpenFace(i, j, k)) return;
      for (const int side : {-1, 1}) {
        const Eigen::Vector3i n = c + side * Eigen::Vector3i::UnitX();
        if (!solids.hasOpenFace(n.x(), n.y(), n.z())) continue;
        const bool joined = solids.open[0](side > 0 ? n : c) > 0;
        EXPECT_EQ(solids.sides.sees(c, n), joined) << left << " " << c.transpose();
      }
    });
  }
}

TEST(WallSides, NothingIsGuardedWithoutAThinWall) {
  const GridSpec grid = unitCube(16);
  EXPECT_FALSE(wallAcrossX(grid, 6.3, 5).sides.any());
  EXPECT_FALSE(buildSolidBoundary(grid, closedWalls(), {}, 0).sides.any());
}

/// Water on the right of a wall, none on the left: a cell on the left reads air only, and the other way
/// round.
TEST(WallSides, ACellReadsItsOwnSideOfTheWall) {
  const GridSpec grid = unitCube(16);
  const SolidBoundary solids = wallAcrossX(grid, 7.3, 1);
  const DenseField<float> phi =
      levelSet(grid, [&](const Eigen::Vector3d& x) { return x.x() > 7.8 * grid.dx ? -0.1 : 0.1; });
  for (const int i : {6, 7, 8, 9}) {
    const WallSides::Block block = solids.sides.read(phi, {i, 8, 8});
    const float own = i < 8 ? 0.1f : -0.1f;
    if (!solids.hasOpenFace(i, 8, 8)) continue;
    for (const float value : block) EXPECT_EQ(value, own) << i;
  }
}

TEST(WallSides, SamplesOfALinearFieldAreExact) {
  WallSides::Block block;
  for (int n = 0; n < 27; ++n)
    block[n] =
        0.25f * static_cast<float>(n / 9) + 2 * static_cast<float>(n / 3 % 3) - static_cast<float>(n % 3);
  const WallSides::Sample f = WallSides::sample(block, {0.5f, -0.25f, 0.75f});
  EXPECT_FLOAT_EQ(f.value, 0.25f * 1.5f + 2 * 0.75f - 1.75f);
  EXPECT_FLOAT_EQ(f.gradient.x(), 0.25f);
  EXPECT_FLOAT_EQ(f.gradient.y(), 2);
  EXPECT_FLOAT_EQ(f.gradient.z(), -1);
}

TEST(WallSides, AWalkEndsAtTheWallAndGoesOnAlongIt) {
  const GridSpec grid = unitCube(16);
  const SolidBoundary solids = wallAcrossX(grid, 7.3, 1);
  const Walk free = walkThroughFaces(solids, {3, 8, 8}, {3.5f, 8.5f, 8.5f}, {1.2f, 9.7f, 8.1f});
  EXPECT_EQ(free.cell, Eigen::Vector3i(1, 9, 8));
  EXPECT_EQ(free.at, Eigen::Vector3f(1.2f, 9.7f, 8.1f));
  const Walk held = walkThroughFaces(solids, {6, 8, 8}, {6.5f, 8.5f, 8.5f}, {9.5f, 10.3f, 8.5f});
  EXPECT_TRUE(held.stopped[0]);
  EXPECT_LE(held.cell.x(), 7);
  EXPECT_EQ(held.cell.y(), 10);
  EXPECT_FLOAT_EQ(held.at.y(), 10.3f);
}

TEST(WallSides, AboveItsRimAWallPartsNothing) {
  const GridSpec grid = unitCube(16);
  const SolidBoundary solids = wallAcrossX(grid, 7.3, 1, 6.2);
  const Walk over = walkThroughFaces(solids, {6, 10, 8}, {6.5f, 10.5f, 8.5f}, {9.5f, 10.5f, 8.5f});
  EXPECT_EQ(over.cell, Eigen::Vector3i(9, 10, 8));
  EXPECT_FALSE(solids.sides.guard(6, 12, 8) & WallSides::kNear);
}

}  // namespace
}  // namespace spume::fluid
