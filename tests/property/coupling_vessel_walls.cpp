#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "coupling/scene_builder.h"
#include "coupling/simulation.h"
#include "tests/support/vessel_shares.h"

namespace spume::coupling {
namespace {

using test::Shares;
using test::sharesOf;

constexpr int kResolution = 32;
constexpr double kEdge = 0.12;  // [m]
constexpr double kDx = kEdge / kResolution;
constexpr double kStep = 0.01;       // [s]
constexpr double kRestSpeed = 1e-8;  // [m/s] accuracy, F1: of a liquid at rest
/// Volumes of a liquid at rest, relative: phi is a float, its round-off moves the surface by 1e-7 cells
/// of 10.
constexpr double kRestVolume = 1e-7;

/// A mug in an empty domain that is open above: its wall and bottom are `cells` thick.
Scene mugScene(double cells, const Eigen::Vector3d& offset) {
  Scene scene;
  scene.domain.size = Eigen::Vector3d::Constant(kEdge);
  scene.domain.resolution = kResolution;
  SolidSpec mug;
  mug.name = "mug";
  mug.shape.kind = ShapeKind::vessel;
  mug.shape.centre = Eigen::Vector3d(0.06, 0.02, 0.06) + kDx * offset;
  mug.shape.innerDiameter = 0.06;
  mug.shape.innerHeight = 0.07;
  mug.shape.wallThickness = mug.shape.bottomThickness = cells * kDx;
  scene.solids = {mug};
  scene.coupling.entrainment.enabled = false;
  return scene;
}

void fillMug(Scene& scene, double depth) {
  LiquidBodySpec water;
  water.vessel = "mug";
  water.depth = depth;
  scene.liquidBodies.push_back(water);
}

struct Outcome {
  Shares start, end;
  double fastest = 0;
};

Outcome run(const Scene& scene, int steps) {
  Simulation simulation(scene);
  Outcome outcome;
  outcome.start = sharesOf(simulation);
  for (int n = 0; n < steps; ++n) {
    const StepReport report = simulation.step(kStep);
    outcome.fastest = std::max(outcome.fastest, report.liquid.maxSpeed);
  }
  outcome.end = sharesOf(simulation);
  return outcome;
}

Eigen::Vector3d randomOffset(std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-0.5, 0.5);
  const double x = uniform(random), y = uniform(random), z = uniform(random);
  return {x, y, z};
}

void expectRest(const Scene& scene, int steps, double outside) {
  const Outcome outcome = run(scene, steps);
  EXPECT_LE(outcome.fastest, kRestSpeed);
  EXPECT_NEAR(outcome.end.in / outcome.start.in, 1, kRestVolume);
  EXPECT_NEAR(outcome.end.out, outcome.start.out, kRestVolume * outcome.start.in);
  if (outside == 0) {
    EXPECT_EQ(outcome.end.out, 0);
  }
}

TEST(VesselWalls, WaterInADryMugIsAtRestAtAnySubCellPosition) {
  std::mt19937 random(1);
  for (const double cells : {1.0, 1.3, 1.7, 2.0}) {
    const Eigen::Vector3d offset = randomOffset(random);
    SCOPED_TRACE(testing::Message() << cells << " cells at " << offset.transpose());
    Scene scene = mugScene(cells, offset);
    fillMug(scene, 0.0432);
    expectRest(scene, cells == 1 ? 200 : 10, 0);
  }
}

/// Water in a mug and around it, there from `lower` to `upper`, at levels of their own.
void expectRestOnBothSides(unsigned seed, double surfaceTension, const Eigen::Vector3d& lower,
                           const Eigen::Vector3d& upper) {
  std::mt19937 random(seed);
  for (const double cells : {1.0, 1.3, 1.7, 2.0}) {
    const Eigen::Vector3d offset = randomOffset(random);
    SCOPED_TRACE(testing::Message() << cells << " cells at " << offset.transpose());
    Scene scene = mugScene(cells, offset);
    scene.liquid.surfaceTension = surfaceTension;
    fillMug(scene, 0.05);
    LiquidBodySpec pool;  // a box less the mug's room
    pool.shape.kind = ShapeKind::box;
    pool.shape.lower = lower, pool.shape.upper = upper;
    scene.liquidBodies.push_back(pool);
    expectRest(scene, 10, 1);
  }
}

TEST(VesselWalls, WaterOnBothSidesOfAWallStaysAtItsLevels) {
  expectRestOnBothSides(2, 0, {-1, -1, -1}, {1, 0.0413, 1});
}

/// A flat surface has no tension to balance, also where it ends at a wall: its curvature there may not come
/// from the level outside, nor from a box that ends where the domain does.
TEST(VesselWalls, SurfaceTensionLeavesLevelsOnBothSidesOfAWallAtRest) {
  expectRestOnBothSides(5, 0.0728, {0, 0, 0}, {kEdge, 0.0413, kEdge});
}

/// A ball of water falls into a mug; without control of its volume, which would hide what walls do to it.
TEST(VesselWalls, StirredWaterComesToRestInARoundMug) {
  Scene scene = mugScene(1.7, {0.2, 0.1, -0.3});
  fillMug(scene, 0.035);
  LiquidBodySpec ball;
  ball.shape.kind = ShapeKind::sphere;
  ball.shape.centre = {0.07, 0.075, 0.055};
  ball.shape.radius = 0.014;
  scene.liquidBodies.push_back(ball);
  scene.liquid.volumeControl = false;
  Simulation simulation(scene);
  const double volume = sharesOf(simulation).in;
  double early = 0, late = 0;  // largest kinetic energy of the second half second and of the sixth [J]
  for (int n = 0; n < 300; ++n) {
    const double energy = simulation.step(kStep).liquid.kineticEnergy;
    if (n >= 50 && n < 100) early = std::max(early, energy);
    if (n >= 250) late = std::max(late, energy);
  }
  // A slosh loses seven tenths of it; fed by streams along the wall it doubles and takes on 13 % of water.
  EXPECT_LT(late, 0.5 * early);
  EXPECT_NEAR(sharesOf(simulation).in, volume, 0.06 * volume);
}

TEST(VesselWalls, ATiltedMugHoldsItsWater) {
  std::mt19937 random(3);
  for (const double cells : {1.0, 1.3, 1.7, 2.0}) {
    const Eigen::Vector3d offset = randomOffset(random);
    SCOPED_TRACE(testing::Message() << cells << " cells at " << offset.transpose());
    Scene scene = mugScene(cells, offset);
    fillMug(scene, 0.03);
    scene.solids[0].motion.pivot = {0.06, 0.05, 0.06};
    scene.solids[0].motion.rotationAxis = {0.3, 0.2, 1};
    scene.solids[0].motion.rotation.keys = {{0, 17}};
    expectRest(scene, 10, 0);
  }
}

/// A vessel of five slabs, each as thick as its wall, that fills a pool's corner to corner: its edges are
/// where three slabs meet.
TEST(VesselWalls, ABoxOfSlabsHoldsItsWaterAndKeepsTheOutsideOut) {
  std::mt19937 random(4);
  for (const double cells : {1.0, 1.3, 1.7, 2.0}) {
    const Eigen::Vector3d shift = kDx * randomOffset(random);
    SCOPED_TRACE(testing::Message() << cells << " cells at " << shift.transpose());
    Scene scene = mugScene(cells, {0, 0, 0});
    const double wall = cells * kDx;
    const Eigen::Vector3d low = Eigen::Vector3d(0.035, 0.03, 0.035) + shift,
                          high = Eigen::Vector3d(0.085, 0.08, 0.085) + shift;
    scene.solids.clear();
    for (int slab = 0; slab < 5; ++slab) {
      constexpr int kAxis[] = {1, 0, 0, 2, 2};
      const int axis = kAxis[slab];
      SolidSpec solid;
      solid.shape.kind = ShapeKind::box;
      solid.shape.lower = low - Eigen::Vector3d::Constant(wall);
      solid.shape.upper = high + Eigen::Vector3d(wall, 0, wall);
      if (slab == 2 || slab == 4)
        solid.shape.lower[axis] = high[axis];
      else
        solid.shape.upper[axis] = low[axis];
      scene.solids.push_back(solid);
    }
    // Deep liquid, whose own sides are far from the surface: the room below the rim and all around.
    LiquidBodySpec pool;
    pool.shape.kind = ShapeKind::box;
    pool.shape.lower = {-1, -1, -1};
    pool.shape.upper = {1, 0.0611, 1};
    scene.liquidBodies = {pool};
    Simulation simulation(scene);
    double fastest = 0;
    for (int n = 0; n < 10; ++n) fastest = std::max(fastest, simulation.step(kStep).liquid.maxSpeed);
    EXPECT_LE(fastest, kRestSpeed);
  }
}

TEST(VesselWalls, ABallThroughTheSurfaceLeavesItAtRest) {
  std::mt19937 random(5);
  for (int n = 0; n < 4; ++n) {
    Scene scene = mugScene(1, {0, 0, 0});
    SolidSpec ball;
    ball.shape.kind = ShapeKind::sphere;
    ball.shape.centre = Eigen::Vector3d(0.06, 0.06, 0.06) + 2 * kDx * randomOffset(random);
    ball.shape.radius = 0.021;
    scene.solids = {ball};
    LiquidBodySpec pool;
    pool.shape.kind = ShapeKind::box;
    pool.shape.lower = {-1, -1, -1};
    pool.shape.upper = {1, 0.0613, 1};
    scene.liquidBodies = {pool};
    Simulation simulation(scene);
    double fastest = 0;
    for (int step = 0; step < 10; ++step) fastest = std::max(fastest, simulation.step(kStep).liquid.maxSpeed);
    EXPECT_LE(fastest, kRestSpeed) << n;
  }
}

/// The mug is lifted, carried and tilted: its water goes along.
TEST(VesselWalls, AMugThatIsCarriedAndTiltedKeepsItsWater) {
  std::mt19937 random(6);
  for (const double cells : {1.0, 1.5}) {
    const Eigen::Vector3d offset = randomOffset(random);
    SCOPED_TRACE(testing::Message() << cells << " cells at " << offset.transpose());
    Scene scene = mugScene(cells, offset);
    fillMug(scene, 0.03);
    MotionSpec& motion = scene.solids[0].motion;
    motion.pivot = {0.06, 0.05, 0.06};
    motion.rotation.keys = {{0.2, 0}, {0.8, 20}};
    motion.position.keys = {{0, {0, 0, 0}}, {0.5, {0.01, 0.012, 0.004}}};
    const Outcome outcome = run(scene, 100);
    EXPECT_NEAR(outcome.end.in / outcome.start.in, 1, 0.01);
    EXPECT_EQ(outcome.end.out, 0);
  }
}

}  // namespace
}  // namespace spume::coupling
