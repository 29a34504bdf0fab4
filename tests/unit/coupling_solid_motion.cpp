#include <gtest/gtest.h>

#include "coupling/scene_builder.h"
#include "coupling/solid_motion.h"

namespace spume::coupling {
namespace {

constexpr double kRoundOff = 1e-14;  // a few operations on numbers of order 1
constexpr double kStep = 1e-5;       // [s] of differences in time; the path bends by spin^2 step^2 at most
constexpr double kDifferenceError = 1e-8;

MotionSpec tipping() {
  MotionSpec motion;
  motion.position.keys = {{0, {0, 0, 0}}, {1, {0.2, 0, 0.1}}, {3, {0.2, 0.4, 0}}};
  motion.rotation.keys = {{0.5, 0}, {2.5, 90}};
  motion.rotationAxis = {0, 0, 2};
  motion.pivot = {0.1, 0.2, 0.3};
  return motion;
}

TEST(SolidMotion, TurnsAboutThePivotThenShifts) {
  const Eigen::Vector3d placed(1.1, 0.2, 0.7);  // 1 m from the axis
  const Eigen::Vector3d moved = poseAt(tipping(), 3).toWorld(placed);
  EXPECT_NEAR((moved - Eigen::Vector3d(0.1 + 0.2, 0.2 + 1 + 0.4, 0.7)).norm(), 0, kRoundOff);
  EXPECT_NEAR((poseAt(tipping(), 3).toPlaced(moved) - placed).norm(), 0, kRoundOff);
}

TEST(SolidMotion, VelocityIsTheRateOfItsMaterialPoints) {
  const MotionSpec motion = tipping();
  const Eigen::Vector3d placed(0.4, -0.3, 0.2);
  for (const double t : {0.25, 0.75, 1.5, 2.75, 4.0}) {
    const auto place = [&](double time) { return poseAt(motion, time).toWorld(placed); };
    const Eigen::Vector3d rate = (place(t + kStep) - place(t - kStep)) / (2 * kStep);
    EXPECT_NEAR((velocityAt(motion, place(t), t) - rate).norm(), 0, kDifferenceError) << t;
  }
}

/// A step that ends at a key moved with the stretch before it.
TEST(SolidMotion, VelocityAtAKeyIsThatOfTheStretchThatEndsThere) {
  EXPECT_NEAR((velocityAt(tipping(), {0.1, 0.2, 0.3}, 3) - Eigen::Vector3d(0, 0.2, -0.05)).norm(), 0,
              kRoundOff);
  EXPECT_EQ(velocityAt(tipping(), {0, 0, 0}, 3.1).norm(), 0);
}

TEST(SolidMotion, OneKeyOrEqualKeysDoNotMove) {
  MotionSpec motion;
  EXPECT_FALSE(moves(motion));
  motion.rotation = 30;
  EXPECT_FALSE(moves(motion));
  motion.position.keys = {{0, {1, 0, 0}}, {1, {1, 0, 0}}};
  EXPECT_FALSE(moves(motion));
  EXPECT_TRUE(moves(tipping()));
}

TEST(SolidMotion, SolidsReachTheLiquidInTheirPoses) {
  Scene scene;
  scene.domain.size = {1, 1, 1};
  scene.domain.resolution = 16;
  SolidSpec ball;
  ball.shape.kind = ShapeKind::sphere;
  ball.shape.centre = {0.5, 0.5, 0.5};
  ball.shape.radius = 0.1;
  ball.motion.position.keys = {{0, {0, 0, 0}}, {2, {0.2, 0, 0}}};
  scene.solids = {ball, ball};
  scene.solids[1].motion = {};
  scene.solids[1].motion.position = Eigen::Vector3d(0, 0.2, 0);
  const fluid::LiquidSetup setup = buildLiquidSetup(scene);
  EXPECT_TRUE(setup.solids[0].moves);
  EXPECT_FALSE(setup.solids[1].moves);
  EXPECT_NEAR(setup.solids[0].psi({0.6, 0.5, 0.5}, 1), -0.1, kRoundOff);
  EXPECT_NEAR(setup.solids[0].frozen(1)({0.6, 0.5, 0.5}), -0.1, kRoundOff);
  EXPECT_NEAR((setup.solids[0].velocity({0.6, 0.5, 0.5}, 1) - Eigen::Vector3d(0.1, 0, 0)).norm(), 0,
              kRoundOff);
  EXPECT_NEAR(setup.solids[1].psi({0.5, 0.7, 0.5}, 1), -0.1, kRoundOff);
  EXPECT_NEAR(solidDistance(scene, 2)({0.7, 0.5, 0.5}), -0.1, kRoundOff);
  EXPECT_NEAR((solidVelocity(scene, 1)(0, {0, 0, 0}) - Eigen::Vector3d(0.1, 0, 0)).norm(), 0, kRoundOff);
  EXPECT_EQ(solidVelocity(scene, 1)(-1, {0, 0, 0}).norm(), 0);
}

}  // namespace
}  // namespace spume::coupling
