#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "coupling/scene_builder.h"
#include "coupling/scene_toml.h"
#include "coupling/simulation.h"
#include "tests/support/vessel_shares.h"

namespace spume::coupling {
namespace {

using test::Shares;
using test::sharesOf;

constexpr double kFilled = 1.9;        // [s] the jet has stopped and the water is nearly level
constexpr double kBeforeTheRim = 2.2;  // [s] the glass is turned by 14 degrees: the water is below its rim
constexpr double kLooks = 0.15;        // [s] up to then: drops come and go, what has poured stays
constexpr double kTipped = 4.5;        // [s]
/// Of the jet's volume: what volume control has not yet put back of what the level set loses of splashes.
constexpr double kVolumeTolerance = 0.03;
/// The same where all of it lies in the tray in sheets and drops of a cell: 4 % in the run it is from.
constexpr double kSheetTolerance = 0.08;
/// The books, against a volume that is a sum of float fractions.
constexpr double kRoundOff = 1e-6;
/// What may cling to a glass turned by 115 degrees: its lower side still rises by 25 degrees towards the rim.
constexpr double kLeftInside = 0.1;

/// glass.toml with cells as wide as the glass is thick.
Scene coarseGlass() {
  return readScene(std::string(SPUME_SOURCE_DIR) + "/data/scenes/glass.toml", {{"domain.resolution", "40"}});
}

TEST(Glass, IsFilledHoldsItsWaterAndPoursItOverTheRim) {
  Simulation simulation(coarseGlass());
  const double finger = sharesOf(simulation).in;
  StepReport last;
  const auto runUntil = [&](double t) {
    while (simulation.liquid().time < t - 1e-9) last = simulation.advanceFrame({}).steps.back();
  };
  runUntil(kFilled);
  const double jet = M_PI * 0.008 * 0.008, full = finger + last.poured;
  EXPECT_GE(last.poured, jet * 0.55 * 1.2 * (1 - kRoundOff));
  EXPECT_LE(last.poured, jet * (0.55 * 1.2 + 3 * simulation.liquid().grid.dx));  // and what fills the nozzle
  const Shares filled = sharesOf(simulation);
  EXPECT_NEAR(filled.in, full, kVolumeTolerance * full);
  EXPECT_LE(filled.out, kVolumeTolerance * full);  // drops that splashed over the rim
  double outside = full;
  for (double t = kBeforeTheRim - kLooks; t <= kBeforeTheRim; t += kLooks / 4) {
    runUntil(t);
    outside = std::min(outside, sharesOf(simulation).out);
  }
  EXPECT_LE(outside, filled.out + 1e-3 * full);
  runUntil(kTipped);
  const Shares end = sharesOf(simulation);
  EXPECT_LE(end.in, kLeftInside * full);
  EXPECT_NEAR(last.liquid.targetVolume + last.liquid.dropVolume + last.drained, full, kRoundOff * full);
  EXPECT_NEAR(end.in + end.out + last.liquid.dropVolume + last.drained, full, kSheetTolerance * full);
}

}  // namespace
}  // namespace spume::coupling
