#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "coupling/simulation.h"

namespace spume::coupling {
namespace {

constexpr double kEdge = 0.12, kDepth = 0.062;  // [m]
constexpr double kStep = 0.01;                  // [s]
/// Relative to the pool: volume control follows sudden losses with the delay of its relaxation.
constexpr double kVolumeTolerance = 0.01;

/// A pool of 32^3 cells with a ball that moves through it at 5 cm/s, never nearer than 4 cells to the
/// surface.
Scene slowBall() {
  Scene scene;
  scene.domain.size = Eigen::Vector3d::Constant(kEdge);
  scene.domain.resolution = 32;
  LiquidBodySpec pool;
  pool.shape.lower = {-1, -1, -1};
  pool.shape.upper = {1, kDepth, 1};
  scene.liquidBodies = {pool};
  SolidSpec ball;
  ball.shape.kind = ShapeKind::sphere;
  ball.shape.centre = {0.04, 0.03, 0.06};
  ball.shape.radius = 0.015;
  ball.motion.position.keys = {{0, {0, 0, 0}}, {0.8, {0.04, 0, 0}}};
  scene.solids = {ball};
  scene.coupling.entrainment.onset = 0;  // even the slowest leaver would count
  return scene;
}

/// Markers it meets are pushed, not swallowed, and what it uncovers is filled with liquid.
TEST(MovingSolid, ASlowBallUnderWaterMakesNoBubbles) {
  Simulation simulation(slowBall());
  std::size_t births = 0;
  double lost = 0, worst = 0;
  for (int n = 0; n < 80; ++n) {
    const StepReport report = simulation.step(kStep);
    births += report.births;
    lost = report.gas.bornMarkers + report.gas.bornPockets + report.gas.notEntrained;
    worst = std::max(worst, std::abs(report.liquid.liquidVolume - report.liquid.targetVolume));
  }
  EXPECT_EQ(births, 0u);
  EXPECT_EQ(lost, 0);
  EXPECT_LE(worst, kVolumeTolerance * kDepth * kEdge * kEdge);
}

}  // namespace
}  // namespace spume::coupling
