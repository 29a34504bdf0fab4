#include <gtest/gtest.h>

#include <numbers>

#include "coupling/first_bubbles.h"
#include "coupling/scene_builder.h"
#include "coupling/scene_toml.h"

namespace spume::coupling {
namespace {

constexpr double kRoundOff = 1e-15;

Scene pouring() { return readScene(SPUME_SOURCE_DIR "/data/scenes/pouring.toml"); }

TEST(SceneBuilder, GridCoversTheDomainWithCubes) {
  Scene scene = pouring();
  scene.domain.lower = {1, 2, 3};
  scene.domain.size = {0.16, 0.08, 0.0401};
  const fluid::GridSpec grid = gridOf(scene);
  EXPECT_EQ(grid.cells, Eigen::Vector3i(64, 32, 16));
  EXPECT_EQ(grid.dx, 0.16 / 64);
  EXPECT_EQ(grid.origin, scene.domain.lower);
}

TEST(SceneBuilder, InflowHasTheExactAreaAndItsSpeed) {
  Scene scene = pouring();
  scene.inflows[0].direction = {0, -3, 0};
  scene.inflows[0].speed.keys = {{0, 0.2}, {2, 0.8}};
  const fluid::Inflow inflow = buildLiquidSetup(scene).inflows.at(0);
  EXPECT_NEAR(inflow.area, std::numbers::pi * 1e-4, kRoundOff);
  EXPECT_NEAR((inflow.velocity - Eigen::Vector3d(0, -0.8, 0)).norm(), 0, kRoundOff);
  EXPECT_NEAR(inflow.scale(0) * inflow.velocity.norm(), 0.2, kRoundOff);
  EXPECT_NEAR(inflow.scale(1) * inflow.velocity.norm(), 0.5, kRoundOff);
  EXPECT_NEAR(inflow.scale(3) * inflow.velocity.norm(), 0.8, kRoundOff);
}

TEST(SceneBuilder, InflowIsOpenFromStartUntilStop) {
  Scene scene = pouring();
  scene.inflows[0].start = 1;
  const fluid::Inflow inflow = buildLiquidSetup(scene).inflows.at(0);
  EXPECT_EQ(inflow.scale(0.999), 0);
  EXPECT_EQ(inflow.scale(1), 1);
  EXPECT_EQ(inflow.scale(3.499), 1);
  EXPECT_EQ(inflow.scale(3.5), 0);
}

TEST(SceneBuilder, NozzleLiesBehindItsOutlet) {
  const Scene scene = pouring();
  const fluid::Inflow inflow = buildLiquidSetup(scene).inflows.at(0);
  const Eigen::Vector3d outlet = scene.inflows[0].centre;
  EXPECT_NEAR(inflow.sdf(outlet), 0, kRoundOff);
  EXPECT_GT(inflow.sdf(outlet - Eigen::Vector3d(0, 1e-3, 0)), 0);  // in front: the jet points down
  EXPECT_LT(inflow.sdf(outlet + Eigen::Vector3d(0, 1e-3, 0)), 0);
  EXPECT_NEAR(inflow.sdf(outlet + Eigen::Vector3d(0.012, 1e-3, 0)), 0.002, kRoundOff);
}

TEST(SceneBuilder, InflowThatNeverPoursIsClosedNotRefused) {
  Scene scene = pouring();
  scene.inflows[0].speed = 0;
  const fluid::Inflow inflow = buildLiquidSetup(scene).inflows.at(0);
  EXPECT_GT(inflow.velocity.norm(), 0);
  EXPECT_EQ(inflow.scale(1), 0);
}

TEST(SceneBuilder, PhiIsTheUnionOfTheBodies) {
  Scene scene = pouring();
  scene.liquidBodies.push_back(
      {"drop", {ShapeKind::sphere, {0, 0, 0}, {0, 0, 0}, {0.08, 0.1, 0.08}, {0, 1, 0}, 0.01, 0}});
  const SignedDistance phi = initialPhi(scene);
  EXPECT_NEAR(phi({0.08, 0.05, 0.08}), 0.01, kRoundOff);
  EXPECT_NEAR(phi({0.08, 0.02, 0.08}), -0.02, kRoundOff);
  EXPECT_NEAR(phi({0.08, 0.1, 0.08}), -0.01, kRoundOff);
  scene.liquidBodies.clear();
  EXPECT_GT(initialPhi(scene)({0.08, 0.02, 0.08}), 0);
}

TEST(SceneBuilder, SolidsAndWallsReachTheSetup) {
  Scene scene = pouring();
  scene.solids.push_back(
      {"ball", {ShapeKind::sphere, {0, 0, 0}, {0, 0, 0}, {0.08, 0.03, 0.08}, {0, 1, 0}, 0.01, 0}});
  scene.domain.closed = {true, false, true, true, false, true};
  const fluid::LiquidSetup setup = buildLiquidSetup(scene);
  EXPECT_EQ(setup.walls.closed, scene.domain.closed);
  ASSERT_EQ(setup.solids.size(), 1u);
  EXPECT_EQ(setup.solids[0].name, "ball");
  EXPECT_NEAR(setup.solids[0].psi({0.08, 0.05, 0.08}, 0), 0.01, kRoundOff);
  EXPECT_NEAR(solidDistance(scene)({0.08, 0.05, 0.08}), 0.01, kRoundOff);
}

TEST(SceneBuilder, BubblesAreNumberedInTheOrderOfTheScene) {
  Scene scene = pouring();
  scene.bubbles = {{"", {{0.01, 0.01, 0.01}, {0, 0.1, 0}, 1e-3, {}}},
                   {"", {{0.02, 0.02, 0.02}, {0, 0, 0}, 2e-3, {}}}};
  const foam::BubbleStore bubbles = initialBubbles(scene);
  EXPECT_EQ(bubbles.id, (std::vector<std::uint64_t>{0, 1}));
  EXPECT_EQ(bubbles.radius[1], 2e-3);
  EXPECT_EQ(bubbles.velocity[0], Eigen::Vector3d(0, 0.1, 0));
}

}  // namespace
}  // namespace spume::coupling
