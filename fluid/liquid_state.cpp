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
  to.grid = from.grid;
  to.time = from.time, to.subSteps = from.subSteps, to.lead = from.lead;
  copyInParallel(from.phi, to.phi);
  copyInParallel(from.velocity, to.velocity);
  copyInParallel(from.pressureGradient, to.pressureGradient);
  copyMarkers(from.positive, to.positive);
  copyMarkers(from.negative, to.negative);
  to.volume = from.volume;
  to.drops = from.drops, to.dropsEver = from.dropsEver;
}

}  // namespace spume::fluid
