#include <gtest/gtest.h>

#include <algorithm>

#include "fluid/liquid_solver.h"

namespace spume::fluid {
namespace {

constexpr int kCells = 24;

LiquidSolver speckUnderTheLid(double radius) {
  LiquidSetup setup;
  setup.grid = {Eigen::Vector3i::Constant(kCells), 1.0 / kCells, Eigen::Vector3d::Zero()};
  setup.walls.closed.fill(true);
  const Eigen::Vector3d centre = setup.grid.cellCentre(12, kCells - 1, 12);
  return {FluidParams{}, setup, [=](const Eigen::Vector3d& x) {
            return std::min(x.y() - 0.313, (x - centre).norm() - radius / kCells);
          }};
}

int wetCellsAbove(const LiquidState& liquid, int row) {
  int wet = 0;
  for (int i = 0; i < kCells; ++i)
    for (int j = row; j < kCells; ++j)
      for (int k = 0; k < kCells; ++k) wet += liquid.phi(i, j, k) < 0;
  return wet;
}

/// A cell that is barely wet, without markers: where it hangs, nothing holds it, so it falls freely through
/// 0.66 m in 0.37 s, and the pool gets its volume.
TEST(Specks, FallFromTheLidIntoThePool) {
  LiquidSolver solver = speckUnderTheLid(0.06);
  ASSERT_EQ(wetCellsAbove(solver.state(), kCells / 2), 1);
  const double without = solver.step(1.0 / 90).targetVolume;
  EXPECT_EQ(wetCellsAbove(solver.state(), kCells / 2), 0);
  ASSERT_EQ(solver.state().drops.size(), 1u);
  const double volume = solver.state().drops[0].volume;
  constexpr double kFall = 0.37;  // [s]: sqrt(2 (0.98 - 0.313)/9.8)
  while (solver.state().time < kFall - 0.03) solver.step(1.0 / 90);
  EXPECT_EQ(solver.state().drops.size(), 1u);
  LiquidStepReport report;
  while (solver.state().time < kFall + 0.03) report = solver.step(1.0 / 90);
  EXPECT_EQ(solver.state().drops.size(), 0u);
  EXPECT_NEAR(report.targetVolume, without + volume, 1e-12);  // [m^3]
}

/// A ball that the grid can follow stays on the grid.
TEST(Specks, LargerBodiesAreNone) {
  LiquidSolver solver = speckUnderTheLid(2.3);
  solver.step(1.0 / 90);
  EXPECT_GT(wetCellsAbove(solver.state(), kCells / 2), 10);
}

}  // namespace
}  // namespace spume::fluid
