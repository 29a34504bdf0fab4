#pragma once

#include <Eigen/Core>

#include "foam/bubble_store.h"
#include "foam/foam_params.h"
#include "foam/foam_topology.h"

namespace spume::foam {

/// Radius of the ball that holds `gas` alone [m].
double gasRadius(double gas);

/// Share of a ball on the free side of a flat wall at distance psi [m] from its centre [-]: 1/2 with the
/// centre on it.
double freeShare(double psi, double radius);

/// Moves every cell's volume towards its gas: r *= (V0 / V)^((1 - exp(-gamma dt)) / 3), r <= limit r0. Also
/// copies volume and hidden flags into the store and flags the clamped. Of a bubble on a wall at distance
/// `psi` [m] only the free share of the cell counts (exact for a bubble without films). A hidden bubble has
/// no volume to correct: its ball returns to r0 at the same rate. Deviation: [Busaryev 2012, 5.2] multiplies
/// by 1 + gamma ((V0/V)^(1/3) - 1) dt, which depends on dt and overshoots, and doubles the volume of every
/// wall bubble.
void correctVolumes(const FoamParams& params, const FoamTopology& topology, const Eigen::VectorXd& psi,
                    double dt, BubbleStore& bubbles);

}  // namespace spume::foam
