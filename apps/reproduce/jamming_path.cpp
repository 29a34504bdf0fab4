#include "apps/reproduce/jamming_path.h"

#include <algorithm>

namespace spume::apps {
namespace {

constexpr double kShrink = 0.5;  // of the way to jamming
constexpr std::size_t kMaxStates = 30;

}  // namespace

double excessContacts(const SoftPacking::Census& census, int balls, int dimensions) {
  const double held = census.held * balls, isostatic = 2 * dimensions * (1 - 1 / held);
  return census.contacts - isostatic;
}

JammingPath::JammingPath(SoftPacking& packing, double nearest, const std::function<void()>& look) {
  jams = packing.fraction() - 0.03;  // a first guess, for the first step
  do {
    if (!states.empty()) packing.setFraction(jams + kShrink * (states.back().fraction - jams));
    settled = packing.relax() && settled;
    unrest = std::max(unrest, packing.unrest());
    worstArea = std::max(worstArea, packing.worstArea());
    states.push_back({packing.fraction(), packing.census()});
    look();
    if (states.size() < 2) continue;
    const State &before = states[states.size() - 2], &now = states.back();
    jams = now.fraction - now.census.pressure * (before.fraction - now.fraction) /
                              (before.census.pressure - now.census.pressure);
  } while (states.back().fraction - jams > nearest && states.size() < kMaxStates);
}

}  // namespace spume::apps
