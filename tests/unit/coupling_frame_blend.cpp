#include <gtest/gtest.h>

#include "coupling/frame_blend.h"
#include "coupling/trilinear.h"

namespace spume::coupling {
namespace {

constexpr double kInterval = 1.0 / 30, kDensity = 1000;
const Eigen::Vector3d kGravity{0, -9.81, 0};
const fluid::GridSpec kGrid{{40, 20, 20}, 0.01, {0, 0, 0}};

/// A ball of liquid of 5 cells radius whose velocity is `velocity` everywhere.
fluid::LiquidState ballAt(const Eigen::Vector3d& centre, const Eigen::Vector3d& velocity) {
  fluid::LiquidState liquid;
  liquid.grid = kGrid;
  liquid.phi = fluid::DenseField<float>(kGrid.cells);
  liquid.velocity = liquid.pressureGradient = fluid::MacField<float>(kGrid.cells);
  for (int i = 0; i < kGrid.cells.x(); ++i)
    for (int j = 0; j < kGrid.cells.y(); ++j)
      for (int k = 0; k < kGrid.cells.z(); ++k)
        liquid.phi(i, j, k) = static_cast<float>((kGrid.cellCentre(i, j, k) - centre).norm() - 0.05);
  for (int axis = 0; axis < 3; ++axis) liquid.velocity[axis].fill(static_cast<float>(velocity[axis]));
  return liquid;
}

double phiAt(const fluid::LiquidState& liquid, const Eigen::Vector3d& x) {
  return interpolateAt(liquid.phi, firstCentre(), kGrid.toCells(x));
}

/// A ball that goes from 0.1 to 0.2 m, its own diameter, at a speed that grows from 2 to 4 m/s.
class MovingBall : public ::testing::Test {
 protected:
  const Eigen::Vector3d start{0.1, 0.1, 0.1}, end{0.2, 0.1, 0.1};
  const fluid::LiquidState before = ballAt(start, {2, 0, 0}), after = ballAt(end, {4, 0, 0});
  fluid::LiquidState blended(double share) const {
    fluid::LiquidState now = before;
    blendFrames({before, after, kInterval}, share, kDensity, kGravity, now);
    return now;
  }
};

TEST_F(MovingBall, IsTheFrameItselfAtAFrame) {
  const fluid::LiquidState first = blended(0), last = blended(1);
  for (int i = 0; i < kGrid.cells.x(); ++i) {
    EXPECT_FLOAT_EQ(first.phi(i, 10, 10), before.phi(i, 10, 10)) << i;
    EXPECT_FLOAT_EQ(last.phi(i, 10, 10), after.phi(i, 10, 10)) << i;
    EXPECT_FLOAT_EQ(first.velocity[0](i, 10, 10), 2) << i;
    EXPECT_FLOAT_EQ(last.velocity[0](i, 10, 10), 4) << i;
  }
}

TEST_F(MovingBall, IsOneBallHalfWayAndNotTwo) {
  const Eigen::Vector3d steady(3, 0, 0), centre(0.15, 0.1, 0.1);
  const fluid::LiquidState early = ballAt(start, steady), late = ballAt(end, steady);
  fluid::LiquidState now = early;
  blendFrames({early, late, kInterval}, 0.5, kDensity, kGravity, now);
  // Of a surface of 5 cells radius, interpolated twice: along two axes each time, dx^2/8 over the radius.
  const double bend = 2 * 2 * kGrid.dx / (8 * 5);
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-0.05, 0.05})
      EXPECT_NEAR(phiAt(now, centre + side * Eigen::Vector3d::Unit(axis)), 0, bend) << axis << ' ' << side;
}

TEST_F(MovingBall, IsNeitherLeftBehindNorAheadOfItsTimeWhereItIsSpedUp) {
  const fluid::LiquidState now = blended(0.5);
  // Sped up evenly it has gone 2 t + a t^2/2 by now; of the velocity out of the ball one frame knows half.
  const double t = kInterval / 2, a = 2 / kInterval;
  const Eigen::Vector3d centre = start + Eigen::Vector3d(2 * t + a * t * t / 2, 0, 0);
  EXPECT_NEAR(phiAt(now, centre + Eigen::Vector3d(0.05, 0, 0)), 0, kGrid.dx);
  EXPECT_NEAR(phiAt(now, centre - Eigen::Vector3d(0.05, 0, 0)), 0, kGrid.dx);
}

TEST_F(MovingBall, HasTheVelocityOfTheNearerFrame) {
  EXPECT_FLOAT_EQ(blended(0.4).velocity[0](13, 10, 10), 2);
  EXPECT_FLOAT_EQ(blended(0.6).velocity[0](17, 10, 10), 4);
}

TEST_F(MovingBall, IsPushedByThePressureThatSpeedsItUp) {
  const fluid::LiquidState now = blended(0.5);
  const double acceleration = 2 / kInterval, kFloat = 1e-6;
  EXPECT_NEAR(now.pressureGradient[0](13, 10, 10), -kDensity * acceleration,
              kFloat * kDensity * acceleration);
  EXPECT_NEAR(now.pressureGradient[1](13, 10, 10), kDensity * kGravity.y(), kFloat * kDensity * 9.81);
  EXPECT_EQ(now.pressureGradient[0](30, 10, 10), 0) << "in the air";
}

}  // namespace
}  // namespace spume::coupling
