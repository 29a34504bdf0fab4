#include <gtest/gtest.h>

#include "fluid/open_boundary.h"
#include "tests/fluid_scenery.h"

namespace spume::fluid {
namespace {

using namespace testing;

/// Liquid that touches the open top and falls by 1.5 cells leaves 1.5 cells of air above it.
TEST(OpenBoundary, AirFollowsLiquidThatLeavesTheFace) {
  const GridSpec grid = boxGrid(8);
  const SolidBoundary boundary = buildSolidBoundary(grid, DomainWalls{}, {}, 0);
  MacVelocity velocity(grid.cells);
  velocity[1].fill(-1);
  DenseField<float> phi(grid.cells, static_cast<float>(-3 * grid.dx));
  admitAir(grid, boundary, velocity, 1.5 * grid.dx, phi);
  const float dx = static_cast<float>(grid.dx);
  EXPECT_FLOAT_EQ(phi(3, 7, 3), dx);
  EXPECT_NEAR(phi(3, 6, 3), 0, 1e-6f * dx);
  EXPECT_NEAR(phi(3, 5, 3), -dx, 1e-6f * dx);
  EXPECT_FLOAT_EQ(phi(3, 2, 3), -3 * dx);
}

TEST(OpenBoundary, NothingEntersWhereLiquidLeavesOrAWallIs) {
  const GridSpec grid = boxGrid(8);
  const SolidBoundary boundary = buildSolidBoundary(grid, DomainWalls{}, {}, 0);
  MacVelocity velocity(grid.cells);
  velocity[1].fill(1);  // out of the open top, into the closed bottom
  DenseField<float> phi(grid.cells, static_cast<float>(-grid.dx));
  const DenseField<float> before = phi;
  admitAir(grid, boundary, velocity, 2 * grid.dx, phi);
  for (int j = 0; j < 8; ++j) EXPECT_EQ(phi(3, j, 3), before(3, j, 3));
}

}  // namespace
}  // namespace spume::fluid
