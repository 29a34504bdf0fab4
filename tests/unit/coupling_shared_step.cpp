// The step that liquid and foam share: when things happen in it.
#include <gtest/gtest.h>

#include <cmath>

#include "coupling/simulation.h"
#include "tests/support/coupling_shapes.h"

namespace spume::coupling {
namespace {

/// Bubbles of 1 mm that rise into each other at 0.2 m/s, which the foam follows in steps of some 3 ms, and
/// burst soon at the surface. The shared steps are a whole frame long.
Scene crowd() {
  Scene scene;
  scene.domain.size = {0.06, 0.06, 0.06};
  scene.domain.resolution = 12;
  scene.stillPool = {true, 0.03};
  scene.time.minDt = 1e-4, scene.time.maxDt = 0.04;
  scene.foam.burstMedianLife = 0.05;
  BubbleSourceSpec source;
  source.shape = test::boxShape({0.02, 0.005, 0.02}, {0.04, 0.02, 0.04});
  source.rate = 1000;
  source.radius = {foam::RadiusLaw::uniform, 0, 0, 0, 0.9e-3, 1.1e-3};
  scene.bubbleSources = {source};
  return scene;
}

constexpr double kRoundOff = 1e-9;  // in sub-steps: a time of seconds over one of a millisecond

TEST(SharedStep, EventsOfTheFoamHappenAtTheEndOfItsSubSteps) {
  Simulation simulation(crowd());
  int split = 0, inBetween = 0, atTheEnd = 0;
  for (int frame = 0; frame < 12; ++frame)
    simulation.advanceFrame([&](const StepReport& step) {
      split += step.foamSubSteps > 1;
      double last = 0;
      for (const Event& event : step.events) {
        const bool ofTheFoam = event.kind == Event::Kind::burst || event.kind == Event::Kind::merge ||
                               event.kind == Event::Kind::classChange;
        if (!ofTheFoam) {
          EXPECT_EQ(event.time, step.time);
          continue;
        }
        const double subStep = step.dt / step.foamSubSteps;
        const double ends = (event.time - (step.time - step.dt)) / subStep;
        EXPECT_NEAR(ends, std::round(ends), kRoundOff);
        EXPECT_GE(std::round(ends), 1);
        EXPECT_LE(event.time, step.time);
        EXPECT_GE(event.time, last) << "in the order in which they happened";
        last = event.time;
        (event.time < step.time ? inBetween : atTheEnd)++;
      }
    });
  EXPECT_GT(split, 5);
  EXPECT_GT(inBetween, 20);
  EXPECT_GT(atTheEnd, 0);
}

}  // namespace
}  // namespace spume::coupling
