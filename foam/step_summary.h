#pragma once

#include "foam/bubble_store.h"
#include "foam/foam_solver.h"
#include "foam/foam_topology.h"

namespace spume::foam {

/// Fills in what a report tells of all bubbles at the end of a step: counts, gas, the fastest, and the errors
/// of the volumes of those that are neither hidden nor at the limit of their radius.
void summarise(const BubbleStore& bubbles, const FoamTopology& topology, FoamStepReport& report);

}  // namespace spume::foam
