// Liquid at rest in closed form, as scenes ask for it.
#include <gtest/gtest.h>

#include <numbers>

#include "coupling/still_liquid.h"
#include "tests/support/coupling_shapes.h"

namespace spume::coupling {
namespace {

Scene pool() {
  Scene scene;
  scene.domain.size = {0.1, 0.1, 0.1};
  scene.domain.resolution = 20;
  scene.stillPool = {true, 0.033};
  return scene;
}

template <typename Ask>
double scalarAt(const Eigen::Vector3d& x, const Ask& ask) {
  Eigen::VectorXd out(1);
  ask(x, out);
  return out[0];
}

double phiAt(const PoolSampler& sampler, const Eigen::Vector3d& x) {
  return scalarAt(x, [&](auto& point, auto& out) { sampler.phi(point, out); });
}
double psiAt(const PoolSampler& sampler, const Eigen::Vector3d& x) {
  return scalarAt(x, [&](auto& point, auto& out) { sampler.psi(point, out); });
}

TEST(StillLiquid, HasAFlatSurfaceBetweenTheWalls) {
  const PoolSampler sampler(pool());
  EXPECT_NEAR(phiAt(sampler, {0.02, 0.05, 0.07}), 0.017, 1e-15);
  EXPECT_NEAR(phiAt(sampler, {0.02, 0.01, 0.07}), -0.023, 1e-15);
  EXPECT_NEAR(psiAt(sampler, {0.02, 0.05, 0.07}), 0.02, 1e-15);
  EXPECT_NEAR(psiAt(sampler, {0.05, 0.099, 0.05}), 0.05, 1e-15);  // open at the top
}

TEST(StillLiquid, HoldsItsVolumeForEver) {
  Scene scene = pool();
  scene.solids = {test::solidOf("block", test::boxShape({0, 0, 0}, {0.05, 0.05, 0.05}))};
  StillLiquid liquid(scene);
  // The solid's faces lie on faces of cells, so the volume is exact up to float.
  EXPECT_NEAR(liquid.liquidVolume(), (0.1 * 0.1 - 0.05 * 0.05) * 0.033, 1e-6 * 1e-3);
  const fluid::LiquidStepReport report = liquid.step(0.1, {}, {});
  EXPECT_EQ(report.liquidVolume, report.targetVolume);
  EXPECT_EQ(report.maxSpeed, 0);
  EXPECT_NEAR(liquid.state().time, 0.1, 1e-15);
  liquid.rollBack();
  EXPECT_EQ(liquid.state().time, 0);
}

TEST(StillLiquid, SolidsAreExact) {
  Scene scene = pool();
  scene.solids = {test::solidOf("ball", test::ballShape({0.05, 0.05, 0.05}, 0.02))};
  const PoolSampler sampler(scene);
  const Eigen::Vector3d x(0.05 + 0.03 * 0.6, 0.05, 0.05 + 0.03 * 0.8);
  EXPECT_NEAR(psiAt(sampler, x), 0.01, 1e-15);
  Eigen::Matrix3Xd slope(3, 1);
  Eigen::VectorXi solid(1);
  sampler.gradPsi(x, slope);
  sampler.solidIndex(x, solid);
  EXPECT_NEAR((slope.col(0) - Eigen::Vector3d(0.6, 0, 0.8)).norm(), 0, 1e-8);
  EXPECT_EQ(solid[0], 0);
  sampler.solidIndex(Eigen::Vector3d(0.001, 0.05, 0.05), solid);
  EXPECT_EQ(solid[0], -1);
}

TEST(StillLiquid, IsOnlyWhereTheBodiesAre) {
  Scene scene = pool();
  scene.liquidBodies = {test::bodyOf("glassful", test::cylinderShape({0.05, 0.025, 0.05}, 0.03, 0.05))};
  const PoolSampler sampler(scene);
  EXPECT_NEAR(phiAt(sampler, {0.05, 0.031, 0.05}), -0.002, 1e-15);
  EXPECT_NEAR(phiAt(sampler, {0.05, 0.034, 0.05}), 0.001, 1e-15);
  EXPECT_GT(phiAt(sampler, {0.09, 0.02, 0.05}), 0.005);
  EXPECT_LT(phiAt(sampler, {0.0795, 0.02, 0.05}), -0.002);  // at the glass
}

TEST(StillLiquid, FollowsGravity) {
  Scene scene = pool();
  scene.liquid.gravity = {-9.8, 0, 0};
  const PoolSampler sampler(scene);
  EXPECT_NEAR(phiAt(sampler, {0.05, 0.01, 0.01}), 0.017, 1e-15);
  Eigen::Matrix3Xd up(3, 1);
  sampler.gradPhi(Eigen::Vector3d(0.05, 0.01, 0.01), up);
  EXPECT_EQ(up.col(0), Eigen::Vector3d::UnitX());
}

}  // namespace
}  // namespace spume::coupling
