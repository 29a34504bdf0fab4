#pragma once

#include <functional>
#include <vector>

#include "apps/reproduce/soft_packing.h"

namespace spume::apps {

/// Contacts per ball beyond the isostatic number: balls held in a periodic box need as many contacts as
/// they have coordinates, but for the shifts of all [-]. `balls`: of the packing; one at least must be held.
double excessContacts(const SoftPacking::Census& census, int balls, int dimensions);

/// A packing on its way to where it jams: brought to rest as it is and then in ever larger boxes, each half
/// as far beyond jamming as the one before.
struct JammingPath {
  struct State {
    double fraction;
    SoftPacking::Census census;
  };

  /// Down to `nearest` beyond jamming, in at most 30 states. `look` is called at each.
  JammingPath(
      SoftPacking& packing, double nearest, const std::function<void()>& look = [] {});

  std::vector<State> states;
  double jams = 0;       ///< the fraction at which the pressure would vanish, from the last two states
  double unrest = 0;     ///< largest net force left in any state over the mean of its contacts
  double worstArea = 0;  ///< largest of any state
  bool settled = true;   ///< whether the packing came to rest in all of them
};

}  // namespace spume::apps
