// One bubble in still liquid against closed forms (accuracy, 3.1: B2, B3, B7; B1 in apps_clusters).
#include <gtest/gtest.h>

#include <algorithm>

#include "foam/forces/drag.h"
#include "tests/foam_fixtures.h"

namespace spume::foam::test {
namespace {

const double kDiameters[] = {.2, .3, .5, .7, 1.0, 1.3, 1.5, 2, 2.5, 3, 4, 5, 6, 8, 10, 15, 20};  // [mm]
const double kSteps[] = {0.001, 0.005, 0.02};                                                    // [s]

/// Speed of one bubble after `time` of rise from rest in a deep pool.
double riseSpeed(const FoamParams& params, double diameter, double dt, double time) {
  FoamSolver solver(params);
  BubbleStore bubbles;
  bubbles.add(bubbleAt({0, 0, 0}, diameter / 2));
  const StillPool pool = deepPool(params);
  for (double t = 0; t < time; t += dt) solver.step(bubbles, pool, dt);
  return bubbles.velocity[0].y();
}

TEST(LoneBubble, PaperModeRisesAtItsClosedForm) {
  // sqrt(4 pi r rho g / 3 c), less the weight of the gas.
  FoamParams params = waterParams(Preset::paper);
  for (const double diameter : {0.5e-3, 2e-3, 5e-3}) {
    const double drive = (params.density - params.gasDensity) * 9.81;
    const double expected =
        std::sqrt(4 * std::numbers::pi * diameter / 2 * drive / (3 * params.dragCoefficient));
    for (const double dt : kSteps) EXPECT_NEAR(riseSpeed(params, diameter, dt, 2), expected, 1e-6 * expected);
  }
}

TEST(LoneBubble, StartsWithTheAddedMassAndNeverOvershoots) {
  FoamParams params = makePreset(Preset::physical);
  const double a0 = (params.density - params.gasDensity) * 9.8 / (params.gasDensity + params.density / 2);
  EXPECT_NEAR(a0, 19.53, 0.005);  // accuracy, B2
  constexpr double kAim = 0.02;   // of the exact speed, at dt = 1 ms
  // The terminal speed is that after 1000 steps of 1 ms, each solved to 1e-9.
  constexpr double kSettled = 1e-8;
  for (const double diameter : {0.2e-3, 1e-3, 3e-3, 10e-3, 20e-3}) {
    const double terminal = riseSpeed(params, diameter, 0.001, 1);
    FoamSolver solver(params);
    BubbleStore bubbles;
    bubbles.add(bubbleAt({0, 0, 0}, diameter / 2));
    const StillPool pool = deepPool(params);
    for (int step = 1; step <= 100; ++step) {
      solver.step(bubbles, pool, 0.001);
      const double exact = terminal * std::tanh(a0 * 0.001 * step / terminal);
      ASSERT_NEAR(bubbles.velocity[0].y(), exact, kAim * exact) << "d " << diameter << " step " << step;
      ASSERT_LE(bubbles.velocity[0].y(), terminal * (1 + kSettled));
    }
    for (const double dt : {0.005, 0.02, 1.0})
      EXPECT_LE(riseSpeed(params, diameter, dt, dt), terminal * (1 + kSettled)) << "first step of " << dt;
  }
}

TEST(LoneBubble, SlipDiesOutWithoutChangingSign) {
  // Without gravity the slip has no terminal value but zero: it must shrink every step and never turn round.
  FoamParams params = waterParams(Preset::physical);
  for (const double diameter : kDiameters) {
    const double slip = 10 * terminalSpeed(params, diameter * 1e-3);
    for (const double dt : kSteps)
      for (const double sign : {-1.0, 1.0}) {
        FoamParams weightless = params;
        weightless.gravity.setZero();
        FoamSolver solver(weightless);
        BubbleStore bubbles;
        bubbles.add(bubbleAt({0, 0, 0}, diameter * 0.5e-3, {0.3 + sign * slip, 0, 0}));
        const StillPool stream = deepPool(weightless, {0.3, 0, 0});
        double before = slip;
        for (int step = 0; step < 20; ++step) {
          solver.step(bubbles, stream, dt);
          const double now = sign * (bubbles.velocity[0].x() - 0.3);
          ASSERT_GT(now, 0);
          ASSERT_LT(now, before);
          before = now;
        }
      }
  }
}

/// Lets one bubble rise into a surface and checks that it stays there.
void expectCapture(Preset preset, double radius, double depth, double dt) {
  SCOPED_TRACE(testing::Message() << "r " << radius << " m, dt " << dt << " s");
  FoamParams params = makePreset(preset);
  params.bursting = false;
  FoamSolver solver(params);
  BubbleStore bubbles;
  bubbles.add(bubbleAt({0, -depth, 0}, radius));
  const StillPool pool = openPool(params);
  std::size_t changes = 0;
  double highest = -depth;
  for (double t = 0; t < 1.5; t += dt) {
    changes += solver.step(bubbles, pool, dt).events.size();
    highest = std::max(highest, bubbles.position[0].y());
  }
  EXPECT_LE(highest, radius);
  EXPECT_EQ(bubbles.type[0], BubbleClass::surface);
  EXPECT_EQ(changes, 1u);
}

TEST(LoneBubble, IsCapturedByTheSurface) {
  for (const Preset preset : {Preset::paper, Preset::physical})
    for (const double dt : {0.001, 0.003, 0.007, 0.02})
      for (int k = 0; k <= 20; ++k) {
        const double radius = 1e-4 * std::pow(100.0, k / 20.0);
        expectCapture(preset, radius, (3 + 0.37 * k) * radius, dt);
      }
}

}  // namespace
}  // namespace spume::foam::test
