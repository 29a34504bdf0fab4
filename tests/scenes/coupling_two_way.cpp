// A tank with a bubbler: what bubbles give the liquid when the scene says so.
#include <gtest/gtest.h>

#include <cmath>

#include "coupling/simulation.h"
#include "tests/support/coupling_shapes.h"

namespace spume::coupling {
namespace {

using Eigen::Vector3d;

constexpr double kStep = 0.01;  // [s]
constexpr double kEdge = 0.064, kDepth = 0.048;

/// A tank of 16 cells an edge, a bubbler in the middle of its floor.
Scene bubbler(bool twoWay) {
  Scene scene;
  scene.domain.size = Vector3d::Constant(kEdge);
  scene.domain.resolution = 16;
  LiquidBodySpec pool;
  pool.shape = test::boxShape({-1, -1, -1}, {1, kDepth, 1});
  scene.liquidBodies = {pool};
  BubbleSourceSpec source;
  source.shape = test::ballShape({kEdge / 2, 0.008, kEdge / 2}, 0.004);
  source.rate = 600;
  source.radius = {foam::RadiusLaw::uniform, 0, 0, 0, 0.5e-3, 0.6e-3};
  scene.bubbleSources = {source};
  scene.coupling.entrainment.enabled = false;
  scene.coupling.twoWay = twoWay;
  return scene;
}

Vector3d underWay(const Simulation& simulation) {
  Vector3d sum = Vector3d::Zero();
  for (const fluid::Push& push : simulation.state().pushes) sum += push.impulse;
  return sum;
}

/// Mean of the upward velocity on the middle line under the surface [m/s].
double plumeSpeed(const Simulation& simulation) {
  const fluid::LiquidState& liquid = simulation.liquid();
  double sum = 0;
  int faces = 0;
  for (int j = 2; j < 11; ++j, ++faces) sum += liquid.velocity[1](8, j, 8);
  return sum / faces;
}

/// accuracy, B5: what leaves the bubbles arrives in the liquid, a step later.
TEST(TwoWay, TheLiquidIsGivenWhatDragTakesFromTheBubbles) {
  Simulation simulation(bubbler(true));
  double largest = 0;
  for (int step = 0; step < 30; ++step) {
    const Vector3d before = underWay(simulation);
    const StepReport report = simulation.step(kStep);
    largest = std::max(largest, before.norm());
    EXPECT_LE((report.liquid.pushes.given - before).norm(), 1e-12 * largest) << step;
    EXPECT_LE(report.liquid.pushes.withheld.norm(), 1e-12 * largest) << step;
  }
  EXPECT_GT(largest, 0);
}

/// The buoyancy of the plume, a column of 1 cm about as high as the tank, speeds it up by centimetres a second
/// within half a second; without the coupling bubbles rise through water at rest.
TEST(TwoWay, BubblesDragAPlumeOfLiquidUpWithThem) {
  constexpr double kPlume = 0.02, kStill = 0.002;  // [m/s]
  Simulation coupled(bubbler(true)), alone(bubbler(false));
  for (int step = 0; step < 50; ++step) coupled.step(kStep), alone.step(kStep);
  EXPECT_GT(plumeSpeed(coupled), kPlume);
  EXPECT_LT(std::abs(plumeSpeed(alone)), kStill);
  EXPECT_TRUE(alone.state().pushes.empty());
}

/// Impulses under way are state.
TEST(TwoWay, ResumesExactly) {
  const Scene scene = bubbler(true);
  Simulation simulation(scene);
  for (int step = 0; step < 20; ++step) simulation.step(kStep);
  ASSERT_FALSE(simulation.state().pushes.empty());
  Simulation resumed(scene, simulation.state());
  simulation.step(kStep), resumed.step(kStep);
  EXPECT_EQ(simulation.bubbles().velocity, resumed.bubbles().velocity);
  EXPECT_EQ(plumeSpeed(simulation), plumeSpeed(resumed));
}

}  // namespace
}  // namespace spume::coupling
