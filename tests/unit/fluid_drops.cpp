#include <gtest/gtest.h>

#include "fluid/drops.h"
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
    Drops drops(air.grid);
    drops.restore({{x0, v0, 1e-9}});
    DropReport report;
    for (int n = 0; n < steps; ++n) drops.advance(air.scene(), air.phi, 0.1 / steps, report);
    ASSERT_EQ(drops.all().size(), 1u);
    const Eigen::Vector3d exact = x0 + 0.1 * v0 + 0.5 * 0.01 * air.params.gravity;
    EXPECT_LT((drops.all()[0].position - exact).norm(), 1e-14);
    EXPECT_LT((drops.all()[0].velocity - (v0 + 0.1 * air.params.gravity)).norm(), 1e-14);
  }
}

TEST(Drops, LandWithTheirVolumeAndMomentum) {
  Air air;
  Drops drops(air.grid);
  drops.restore({{{0.5, 0.5, 0.5}, {0, -1, 0}, 2e-9}, {{0.5, 0.9, 0.5}, {0, 5, 0}, 3e-9}});
  DropReport report;
  for (int n = 0; n < 15; ++n) drops.advance(air.scene(), air.phi, 0.01, report);
  ASSERT_EQ(report.landed.size(), 1u);
  EXPECT_EQ(report.landed[0].volume, 2e-9);
  EXPECT_DOUBLE_EQ(report.landed[0].volume + drops.volume() + report.left, 5e-9);
  EXPECT_LE(drops.all()[0].position.y(), 1);  // the closed lid stopped it
}

TEST(Drops, LeaveThroughOpenSides) {
  Air air;
  air.walls.closed[3] = false;
  Drops drops(air.grid);
  drops.restore({{{0.5, 0.9, 0.5}, {0, 20, 0}, 3e-9}});
  DropReport report;
  drops.advance(air.scene(), air.phi, 0.02, report);
  EXPECT_EQ(report.left, 3e-9);
  EXPECT_TRUE(drops.all().empty());
}

TEST(Drops, SlideOffASolid) {
  Air air;
  const SolidObject floor{"floor", [](const Eigen::Vector3d& x, double) { return x.y() - 0.5; }, {}, false};
  air.solids = buildSolidBoundary(air.grid, air.walls, {floor}, 0);
  Drops drops(air.grid);
  drops.restore({{{0.3, 0.52, 0.5}, {1, -2, 0}, 1e-9}});
  DropReport report;
  drops.advance(air.scene(), air.phi, 0.02, report);
  ASSERT_EQ(drops.all().size(), 1u);
  EXPECT_NEAR(drops.all()[0].position.y(), 0.5, 1e-6);
  EXPECT_NEAR(drops.all()[0].velocity.y(), 0, 1e-9);
  EXPECT_NEAR(drops.all()[0].velocity.x(), 1, 1e-9);
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
  MarkerShares shares(air.grid);
  const double share = shares.refresh(air.scene(), air.phi, MarkerSign::negative, negative);
  EXPECT_NEAR(share / liquidVolume(air.grid, air.phi, air.solids), 1, 0.05);  // slivers hold no marker
  air.phi.fill(kLevelSetBand * static_cast<float>(air.grid.dx));              // the grid loses the ball
  const MacVelocity fall = macField(air.grid, [](const auto&) { return Eigen::Vector3d(0, -1, 0); });
  Drops drops(air.grid);
  const double launched = drops.launch(air.scene(), air.phi, fall, negative);
  EXPECT_NEAR(launched / share, 1, 1e-5);  // float shares
  EXPECT_DOUBLE_EQ(drops.volume(), launched);
  EXPECT_EQ(negative.size(), 0u);
  EXPECT_NEAR(drops.momentum(1000).y() / (-1000 * launched), 1, 1e-6);
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
