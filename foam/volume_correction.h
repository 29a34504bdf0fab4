#pragma once

#include "foam/bubble_store.h"
#include "foam/foam_params.h"
#include "foam/foam_topology.h"

namespace spume::foam {

/// Radius of the ball that holds `gas` alone [m].
double gasRadius(double gas);

/// Moves every cell's volume towards its gas by the share 1 - exp(-gamma dt) of what is missing, r <= limit
/// r0. relax: each by itself, r *= (V0 / V)^(share / 3). newton: all together by the derivatives of the
/// volumes, so that what one cell gains its neighbours do not lose; the whole of it once the foam is at rest.
/// Copies volumes and hidden flags into the store and flags the clamped. A hidden bubble has no volume to
/// correct: its ball returns to r0 at the same rate. Deviation: [Busaryev 2012, 5.2] multiplies by 1 + gamma
/// ((V0/V)^(1/3) - 1) dt, which depends on dt and overshoots.
void correctVolumes(const FoamParams& params, const FoamTopology& topology, double dt, BubbleStore& bubbles);

}  // namespace spume::foam
