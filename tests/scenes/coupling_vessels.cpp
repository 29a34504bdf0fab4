#include <gtest/gtest.h>

#include <cmath>

#include "coupling/scene_builder.h"
#include "coupling/shapes.h"
#include "coupling/simulation.h"
#include "coupling/solid_motion.h"
#include "fluid/level_set.h"

namespace spume::coupling {
namespace {

constexpr double kEdge = 0.12;       // [m] of the domain
constexpr int kResolution = 32;      // cells of 3.75 mm
constexpr double kRestSpeed = 1e-8;  // [m/s]
constexpr double kStep = 0.01;       // [s]
/// Relative to what was filled in: volume control follows the level set's losses with a delay of 10 ms.
constexpr double kVolumeTolerance = 0.01;

/// An empty domain, open at the top, with a mug whose wall and bottom are one cell thick.
Scene mugScene(const Eigen::Vector3d& offset) {
  Scene scene;
  scene.domain.size = Eigen::Vector3d::Constant(kEdge);
  scene.domain.resolution = kResolution;
  SolidSpec mug;
  mug.name = "mug";
  mug.shape.kind = ShapeKind::vessel;
  mug.shape.centre = Eigen::Vector3d(0.06, 0.02, 0.06) + offset;
  mug.shape.innerDiameter = 0.06;
  mug.shape.innerHeight = 0.07;
  mug.shape.wallThickness = mug.shape.bottomThickness = kEdge / kResolution;
  scene.solids = {mug};
  return scene;
}

void fill(Scene& scene, double depth) {
  LiquidBodySpec water;
  water.vessel = "mug";
  water.depth = depth;
  scene.liquidBodies = {water};
}

/// Liquid [m^3] outside the room of the mug and its mouth as it stands.
double spilt(const Simulation& simulation) {
  const SolidSpec& mug = simulation.scene().solids[0];
  const Pose pose = poseAt(mug.motion, simulation.liquid().time);
  const fluid::GridSpec& grid = simulation.liquid().grid;
  fluid::DenseField<float> fraction(grid.cells);
  fluid::computeLiquidFraction(simulation.liquid().phi, simulation.solids(), static_cast<float>(grid.dx),
                               fraction);
  double volume = 0;
  for (int i = 0; i < grid.cells.x(); ++i)
    for (int j = 0; j < grid.cells.y(); ++j)
      for (int k = 0; k < grid.cells.z(); ++k)
        if (roomInVessel(mug.shape, pose.toPlaced(grid.cellCentre(i, j, k))) > 0) volume += fraction(i, j, k);
  return volume * grid.cellVolume();
}

struct Outcome {
  double spilt = 0, fastest = 0, worstVolume = 0, poured = 0, drained = 0, held = 0;
  std::size_t births = 0;
};

Outcome run(const Scene& scene, int steps) {
  Simulation simulation(scene);
  Outcome outcome;
  for (int n = 0; n < steps; ++n) {
    const StepReport report = simulation.step(kStep);
    outcome.spilt = std::max(outcome.spilt, scene.solids.empty() ? 0 : spilt(simulation));
    outcome.fastest = std::max(outcome.fastest, report.liquid.maxSpeed);
    const double error = report.liquid.liquidVolume - report.liquid.targetVolume;
    outcome.worstVolume =
        std::max(outcome.worstVolume, std::abs(error) / std::max(report.liquid.targetVolume, 1e-30));
    outcome.births += report.births;
    outcome.poured = report.poured;
    outcome.drained = report.drained;
    outcome.held = report.liquid.liquidVolume;
  }
  return outcome;
}

TEST(Vessels, WaterInAMugIsAtRestAtAnySubCellPosition) {
  constexpr double kDx = kEdge / kResolution;
  for (const Eigen::Vector3d& offset : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0.21, 0.43, 0.77),
                                        Eigen::Vector3d(0.5, 0.5, 0.5), Eigen::Vector3d(0.93, 0.08, 0.36)}) {
    Scene scene = mugScene(kDx * offset);
    fill(scene, 0.0432);
    const Outcome outcome = run(scene, 3);
    EXPECT_LE(outcome.fastest, kRestSpeed) << offset.transpose();
    EXPECT_EQ(outcome.spilt, 0) << offset.transpose();
    const double volume = M_PI * 0.03 * 0.03 * 0.0432;
    EXPECT_NEAR(outcome.held / volume, 1, 0.02) << offset.transpose();  // (dx/R)^2 = 0.016
  }
}

TEST(Vessels, AJetFillsAMugAndNothingLeaks) {
  Scene scene = mugScene({0.0011, 0.0007, 0.0023});
  InflowSpec jet;
  jet.centre = {0.07, 0.105, 0.06};
  jet.radius = 0.009;
  jet.speed = 0.6;
  jet.stop = 0.5;
  scene.inflows = {jet};
  const Outcome outcome = run(scene, 80);
  EXPECT_EQ(outcome.spilt, 0);
  EXPECT_NEAR(outcome.held / outcome.poured, 1, 0.03);  // the jet's losses at a radius of 2.4 cells
}

TEST(Vessels, AMugThatTiltsKeepsItsWater) {
  Scene scene = mugScene({0.0011, 0.0007, 0.0023});
  fill(scene, 0.03);
  MotionSpec& motion = scene.solids[0].motion;
  motion.pivot = {0.06, 0.05, 0.06};
  motion.rotation.keys = {{0, 0}, {0.6, 25}};
  const Outcome outcome = run(scene, 70);
  EXPECT_EQ(outcome.spilt, 0);
  EXPECT_EQ(outcome.births, 0u);
  EXPECT_LE(outcome.worstVolume, kVolumeTolerance);
}

/// A ball that moves under the surface, then through it, makes no bubbles: it is slower than the onset of
/// entrainment, and markers it meets are pushed, not swallowed.
TEST(Vessels, ASlowBallMakesNoBubbles) {
  for (const double start : {0.03, 0.075}) {
    Scene scene;
    scene.domain.size = Eigen::Vector3d::Constant(kEdge);
    scene.domain.resolution = kResolution;
    LiquidBodySpec pool;
    pool.shape.lower = {-1, -1, -1};
    pool.shape.upper = {1, 0.062, 1};
    scene.liquidBodies = {pool};
    SolidSpec ball;
    ball.shape.kind = ShapeKind::sphere;
    ball.shape.centre = {0.04, start, 0.06};
    ball.shape.radius = 0.015;
    ball.motion.position.keys = {{0, {0, 0, 0}}, {0.8, {0.04, start > 0.05 ? -0.04 : 0, 0}}};
    scene.coupling.entrainment.onset = 0;  // even the slowest leaver would count
    scene.solids = {ball};
    Simulation moving(scene);
    std::size_t births = 0;
    double lost = 0, worst = 0;
    for (int n = 0; n < 80; ++n) {
      const StepReport report = moving.step(kStep);
      births += report.births;
      lost = report.gas.bornMarkers + report.gas.bornPockets + report.gas.notEntrained;
      worst = std::max(worst, std::abs(report.liquid.liquidVolume - report.liquid.targetVolume));
    }
    EXPECT_EQ(births, 0u) << start;
    EXPECT_EQ(lost, 0) << start;
    EXPECT_LE(worst, kVolumeTolerance * 0.062 * kEdge * kEdge);
  }
}

}  // namespace
}  // namespace spume::coupling
