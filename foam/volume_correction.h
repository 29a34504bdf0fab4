#pragma once

#include "foam/bubble_store.h"
#include "foam/foam_params.h"
#include "foam/foam_topology.h"

namespace spume::foam {

/// Radius of the ball that holds `gas` alone [m].
double gasRadius(double gas);

/// Moves every cell's volume towards its gas: r *= (V0 / V)^((1 - exp(-gamma dt)) / 3), r <= limit r0. Also
/// copies volume and hidden flags into the store and flags the clamped. A hidden bubble has no volume to
/// correct: its ball returns to r0 at the same rate. Deviation: [Busaryev 2012, 5.2] multiplies by 1 + gamma
/// ((V0/V)^(1/3) - 1) dt, which depends on dt and overshoots.
void correctVolumes(const FoamParams& params, const FoamTopology& topology, double dt, BubbleStore& bubbles);

}  // namespace spume::foam
