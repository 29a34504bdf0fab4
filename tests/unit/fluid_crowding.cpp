#include <gtest/gtest.h>

#include <cmath>

#include "fluid/crowding.h"
#include "fluid/level_set.h"
#include "fluid/level_set_advection.h"
#include "fluid/liquid_solver.h"
#include "tests/support/fluid_fields.h"

namespace spume::fluid {
namespace {

using namespace test;

constexpr int kCells = 16;

/// A slab of liquid in a closed cube of 1 m that moves along y for one step.
struct Slab {
  GridSpec grid = unitCube(kCells);
  SolidBoundary solids = buildSolidBoundary(grid, closedWalls(), {}, 0);
  DenseField<float> phi{grid.cells};
  MacVelocity velocity{grid.cells};
  Crowding crowding{grid};

  /// From `low` to `high` cells, at `speed(y)` cells a step where no wall is, y in cells.
  template <typename Speed>
  Slab(double low, double high, const Speed& speed) {
    initialiseLevelSet(
        grid,
        [&](const Eigen::Vector3d& x) { return std::max(low * grid.dx - x.y(), x.y() - high * grid.dx); },
        phi);
    for (int i = 0; i < kCells; ++i)
      for (int j = 1; j < kCells; ++j)
        for (int k = 0; k < kCells; ++k) velocity[1](i, j, k) = static_cast<float>(speed(j) * grid.dx);
    fillGhostLayers(velocity);
  }

  double volume() const { return liquidVolume(grid, phi, solids) / grid.cellVolume() / (kCells * kCells); }

  /// Moves the slab; returns what is crowded [cells of height].
  double move() {
    LevelSetAdvection advection(grid);
    crowding.prepare(phi, solids, velocity);
    advection.advance(LevelSetTransport::semiLagrangian, velocity, 1, phi);
    crowding.find(phi, solids, velocity, 1);
    double sum = 0;
    for (const CrowdedCell& c : crowding.cells()) sum += c.volume;
    return sum / (kCells * kCells);
  }
};

TEST(Crowding, NothingIsCrowdedByAStreamThatIsNotHeld) {
  Slab slab(9, 13, [](int) { return -3.0; });
  EXPECT_EQ(slab.move(), 0);
  EXPECT_NEAR(slab.volume(), 4, 0.01);
}

/// Two cells above a floor, at three cells a step: one cell's height comes into no room. The velocity falls
/// to nothing in the cell above the floor, which lets the front come within exp(-2) of a cell of it in the
/// two thirds of the step that are left then.
TEST(Crowding, AStreamThatComesUponAWallIsCrowdedByWhatItLost) {
  Slab slab(2, 7, [](int) { return -3.0; });
  const double before = slab.volume(), crowded = slab.move(), lost = before - slab.volume();
  EXPECT_NEAR(lost, 1 + std::exp(-2), 0.25);  // phi is interpolated, paths are of the midpoint rule
  EXPECT_NEAR(crowded, lost, 0.2 * lost);     // three steps a cell
}

/// Beyond its upper surface the velocity grows: phi goes ahead of the liquid.
TEST(Crowding, WhatASpreadingVelocityShowsTooMuchIsNegative) {
  Slab slab(4, 8, [](int j) { return j <= 8 ? 1.0 : 1.0 + 0.5 * (j - 8); });
  const double before = slab.volume(), crowded = slab.move(), gained = slab.volume() - before;
  ASSERT_GT(gained, 0.1);
  EXPECT_NEAR(-crowded, gained,
              0.3 * gained);  // divergence is one number a cell, the surface lies within one
}

/// Of the cell's height that comes into no room the surface above is taken to have room for a quarter.
TEST(Crowding, WhatOneLiftOfTheSurfaceCannotTakeIsExcess) {
  Slab slab(2, 7, [](int) { return -3.0; });
  const double crowded = slab.move(), area = kCells * kCells;
  ASSERT_GT(crowded, 0.8);
  EXPECT_NEAR(slab.crowding.excess() / area, crowded - 0.25, 1e-4);
  EXPECT_NEAR(slab.crowding.excess() / area, crowded - 0.25, 1e-4);  // asked again
  Slab slow(0.5, 7, [](int) { return -0.2; });
  const double little = slow.move();
  ASSERT_GT(little, 0.05);
  ASSERT_LT(little, 0.25);
  EXPECT_EQ(slow.crowding.excess(), 0);
}

/// A ball that falls upon a floor, without volume control: it lost 23 % of itself in its first hundredths of
/// a second there. The rest finds no way up to a surface, or asks for more than half a cell of lift.
TEST(Crowding, ABallKeepsItsVolumeAsItStrikesTheFloor) {
  FluidParams params;
  params.volumeControl = false;
  const GridSpec grid = unitCube(32);
  LiquidSolver solver(params, {grid, closedWalls(), {}, {}}, [](const Eigen::Vector3d& x) {
    return (x - Eigen::Vector3d(0.5, 0.6, 0.5)).norm() - 0.2;
  });
  const double ball = liquidVolume(grid, solver.state().phi, buildSolidBoundary(grid, closedWalls(), {}, 0));
  LiquidStepReport report;
  while (solver.state().time < 0.33) report = solver.step(1.0 / 60);
  const double lost = 1 - (report.liquidVolume + report.dropVolume) / ball;
  EXPECT_NEAR(lost, 0, 0.08);
}

}  // namespace
}  // namespace spume::fluid
