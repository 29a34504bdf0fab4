#include "fluid/liquid_state.h"

#include "fluid/parallel_copy.h"

namespace spume::fluid {
namespace {

void copyMarkers(const MarkerSet& from, MarkerSet& to) {
  to.resize(from.size());
  const auto copy = [&](auto column) {
    copyInParallel((from.*column).data(), from.size(), (to.*column).data());
  };
  copy(&MarkerSet::x), copy(&MarkerSet::y), copy(&MarkerSet::z), copy(&MarkerSet::radius);
  copy(&MarkerSet::gas), copy(&MarkerSet::escaped);
}

}  // namespace

void copyState(const LiquidState& from, LiquidState& to) {
  // Named one by one, so that a new member does not compile until it is copied, too.
  const auto& [grid, time, subSteps, phi, velocity, lead, pressureGradient, positive, negative, volume, drops,
               dropsEver] = from;
  to.grid = grid, to.time = time, to.subSteps = subSteps, to.lead = lead;
  copyInParallel(phi, to.phi);
  copyInParallel(velocity, to.velocity);
  copyInParallel(pressureGradient, to.pressureGradient);
  copyMarkers(positive, to.positive);
  copyMarkers(negative, to.negative);
  to.volume = volume, to.drops = drops, to.dropsEver = dropsEver;
}

}  // namespace spume::fluid
