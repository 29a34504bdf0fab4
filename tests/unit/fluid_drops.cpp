#include <gtest/gtest.h>

#include "fluid/drops.h"
#include "fluid/liquid_solver.h"
#include "tests/support/fluid_fields.h"

namespace spume::fluid {
namespace {

using namespace test;

struct Air {
  GridSpec grid = unitCube(16);
  FluidParams params;
  DomainWalls walls = closedWalls();
  SolidBoundary solids = buildSolidBoundary(grid, walls, {}, 0);
  DenseField<float> phi = levelSet(grid, [](const auto& x) { return x.y() - 0.25; });
  MarkerScene scene() const { return {grid, params, walls, solids}; }
};

TEST(Drops, FlyOnAParabolaWhateverTheStep) {
  Air air;
  const Eigen::Vector3d x0(0.2, 0.5, 0.5), v0(1, 2, 0.3);
  for (const int steps : {1, 7}) {
    std::vector<Drop> drops{{x0, v0, 1e-9}};
    for (int n = 0; n < steps; ++n) fly(air.scene(), air.phi, 0.1 / steps, drops);
    ASSERT_EQ(drops.size(), 1u);
    const Eigen::Vector3d exact = x0 + 0.1 * v0 + 0.5 * 0.01 * air.params.gravity;
    EXPECT_LT((drops[0].position - exact).norm(), 1e-14);
    EXPECT_LT((drops[0].velocity - (v0 + 0.1 * air.params.gravity)).norm(), 1e-14);
  }
}

TEST(Drops, LandWithTheirVolumeAndMomentum) {
  Air air;
  std::vector<Drop> drops{{{0.5, 0.5, 0.5}, {0, -1, 0}, 2e-9}, {{0.5, 0.9, 0.5}, {0, 5, 0}, 3e-9}};
  std::vector<Drop> landed;
  for (int n = 0; n < 15; ++n)
    for (const Drop& drop : fly(air.scene(), air.phi, 0.01, drops).landed) landed.push_back(drop);
  ASSERT_EQ(landed.size(), 1u);
  EXPECT_EQ(landed[0].volume, 2e-9);
  EXPECT_DOUBLE_EQ(landed[0].volume + volumeOf(drops), 5e-9);
  EXPECT_LE(drops[0].position.y(), 1);  // the closed lid stopped it
}

TEST(Drops, LeaveThroughOpenSides) {
  Air air;
  air.walls.closed[3] = false;
  std::vector<Drop> drops{{{0.5, 0.9, 0.5}, {0, 20, 0}, 3e-9}};
  EXPECT_EQ(fly(air.scene(), air.phi, 0.02, drops).left, 3e-9);
  EXPECT_TRUE(drops.empty());
}

TEST(Drops, SlideOffASolid) {
  Air air;
  const SolidObject floor{"floor", [](const Eigen::Vector3d& x, double) { return x.y() - 0.5; }, {}, false};
  air.solids = buildSolidBoundary(air.grid, air.walls, {floor}, 0);
  std::vector<Drop> drops{{{0.3, 0.52, 0.5}, {1, -2, 0}, 1e-9}};
  fly(air.scene(), air.phi, 0.02, drops);
  ASSERT_EQ(drops.size(), 1u);
  EXPECT_NEAR(drops[0].position.y(), 0.5, 1e-6);
  EXPECT_NEAR(drops[0].velocity.y(), 0, 1e-9);
  EXPECT_NEAR(drops[0].velocity.x(), 1, 1e-9);
}

TEST(Drops, CarryTheVolumeOfTheLiquidThatTheGridLost) {
  Air air;
  const double radius = 1.5 * air.grid.dx;
  const auto ball = [&](const Eigen::Vector3d& x) {
    return (x - Eigen::Vector3d(0.52, 0.49, 0.51)).norm() - radius;
  };
  air.phi = levelSet(air.grid, ball);
  MarkerSet positive, negative;
  MarkerSeeder(air.grid).reseed(air.scene(), air.phi, 0, positive, negative);
  Drops drops(air.grid);
  const double share = drops.refreshVolumes(air.scene(), air.phi, positive, negative);
  EXPECT_NEAR(share / liquidVolume(air.grid, air.phi, air.solids), 1, 0.05);  // slivers hold no marker
  air.phi.fill(kLevelSetBand * static_cast<float>(air.grid.dx));              // the grid loses the ball
  const MacVelocity fall = macField(air.grid, [](const auto&) { return Eigen::Vector3d(0, -1, 0); });
  const std::vector<Drop> launched = drops.launch(air.scene(), air.phi, fall, negative);
  EXPECT_NEAR(volumeOf(launched) / share, 1, 1e-5);  // float shares
  EXPECT_EQ(negative.size(), 0u);
  EXPECT_NEAR(momentumOf(launched, 1000).y() / (-1000 * volumeOf(launched)), 1, 1e-6);
}

/// A wall one cell thick stops a drop that would cross it many times over in the step.
TEST(Drops, DoNotTunnelThroughAThinWall) {
  Air air;
  const double half = 0.5 * air.grid.dx;
  const SolidObject wall{
      "wall", [=](const Eigen::Vector3d& x, double) { return std::abs(x.x() - 0.53) - half; }, {}, false};
  air.solids = buildSolidBoundary(air.grid, air.walls, {wall}, 0);
  std::vector<Drop> drops{{{0.2, 0.6, 0.5}, {20, 1, 0}, 1e-9}};
  fly(air.scene(), air.phi, 0.03, drops);
  ASSERT_EQ(drops.size(), 1u);
  EXPECT_LT(drops[0].position.x(), 0.53);
  EXPECT_NEAR(drops[0].velocity.x(), 0, 1e-6);
}

/// A ball smaller than a cell cannot stay on the grid: it must fall as drops, land in the pool and raise it
/// by exactly its volume. The books hold at every step.
TEST(Drops, BringASubCellBallIntoThePool) {
  const GridSpec grid = unitCube(24);
  const double height = 0.3 + 0.2 / 24, radius = 0.9 * grid.dx;
  const auto phi0 = [&](const Eigen::Vector3d& x) {
    return std::min(x.y() - height, (x - Eigen::Vector3d(0.48, 0.62, 0.53)).norm() - radius);
  };
  LiquidSolver solver({}, {grid, closedWalls(), {}, {}}, phi0);
  const double start = solver.liquidVolume();
  double flying = 0, landed = 0;
  for (int n = 0; n < 90; ++n) {  // its splash takes as long as the ball
    const LiquidStepReport report = solver.step(0.01);
    flying = std::max(flying, report.dropVolume);
    landed += report.landed;
    EXPECT_NEAR((report.targetVolume + report.dropVolume) / start, 1, 1e-12);
  }
  EXPECT_GT(flying, 0);
  EXPECT_GT(landed, 0.99 * flying);
  EXPECT_TRUE(solver.state().drops.empty());
  EXPECT_NEAR(solver.liquidVolume() / start, 1, 1e-4);  // what volume control leaves while the pool sways
}

TEST(Drops, AreTakenBackWithAStep) {
  const GridSpec grid = unitCube(16);
  LiquidSolver solver({}, {grid, closedWalls(), {}, {}}, [](const auto& x) { return x.y() - 0.3; });
  LiquidState state = solver.state();
  state.drops = {{{0.5, 0.35, 0.5}, {0, -2, 0}, 1e-6, 7}};
  LiquidSolver resumed({}, {grid, closedWalls(), {}, {}}, state);
  EXPECT_GT(resumed.step(0.05).landed, 0);
  EXPECT_TRUE(resumed.state().drops.empty());
  resumed.rollBack();
  ASSERT_EQ(resumed.state().drops.size(), 1u);
  EXPECT_EQ(resumed.state().drops[0].id, 7u);
}

TEST(DepositMomentum, HandsOverTheMomentumOfASmallDrop) {
  const GridSpec grid = unitCube(8);
  MacVelocity u = macField(grid, [](const auto&) { return Eigen::Vector3d::Zero(); });
  const Drop drop{{0.5, 0.45, 0.55}, {1, -2, 3}, 1e-3 * grid.cellVolume()};
  depositMomentum(grid, {drop}, u);
  Eigen::Vector3d momentum = Eigen::Vector3d::Zero();
  for (int a = 0; a < 3; ++a)
    for (int i = 0; i <= 8; ++i)
      for (int j = 0; j <= 8; ++j)
        for (int k = 0; k <= 8; ++k)
          if (i < u[a].size().x() && j < u[a].size().y() && k < u[a].size().z())
            momentum[a] += u[a](i, j, k) * grid.cellVolume();
  EXPECT_LT((momentum - drop.volume * drop.velocity).norm(), 1e-6 * drop.volume);
}

}  // namespace
}  // namespace spume::fluid
