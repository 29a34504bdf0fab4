// Equal bubbles squeezed between two plates (Busaryev et al. 2012, Fig. 6): their cells hold their gas all
// the time, while they are blown in, rise and pile up, and then come to rest.
#include <gtest/gtest.h>

#include "tests/foam_fixtures.h"

namespace spume::foam::test {
namespace {

StillPool gap() {
  StillPoolParams box;
  box.lower = {0, 0, 0}, box.upper = {0.06, 0.12, 0.006};
  box.surfaceHeight = 0.03;
  box.closed = {true, true, true, true, true, true};
  return StillPool(box);
}

FoamParams soapyFroth() {
  FoamParams params = makePreset(Preset::physical);
  params.surfaceTension = 0.03, params.wetness = 0.2, params.wetnessAloft = 0.05;
  params.volumeMode = VolumeMode::newton, params.bursting = false;
  return params;
}

TEST(FoamBetweenPlates, HoldsItsGasWhileItIsBlownInAndThenRests) {
  constexpr double kWorst = 0.01;  // issue aim; 75 % without correction and 25 % with the paper's
  constexpr double kSlow = 5e-3;   // [m/s] a radius in a second: no shaking, only the last settling
  constexpr int kBubbles = 40;
  constexpr double kRadius = 3.8e-3, kRate = 30;  // [m], wider than half the gap; [1/s]
  for (const double dt : {0.005, 0.02}) {
    const StillPool pool = gap();
    FoamSolver solver(soapyFroth());
    BubbleStore bubbles;
    FoamStepReport report;
    for (double t = 0; t < 6; t += dt) {
      for (; bubbles.size() < kBubbles && static_cast<double>(bubbles.size()) <= t * kRate;) {
        CounterRandom random(7, bubbles.size(), 3);
        bubbles.add(bubbleAt(
            {0.01 + 0.04 * random.uniform(), 0.008 + 0.012 * random.uniform(), 0.006 * random.uniform()},
            kRadius));
      }
      report = solver.step(bubbles, pool, dt);
      ASSERT_LE(report.volumeErrorMax, kWorst) << dt << " " << t;
    }
    EXPECT_EQ(report.hidden + report.clamped, 0u);
    EXPECT_GT(report.air, 20u);
    EXPECT_LE(rmsSpeed(bubbles), kSlow) << dt;
  }
}

}  // namespace
}  // namespace spume::foam::test
