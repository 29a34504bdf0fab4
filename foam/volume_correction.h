#pragma once

#include <cstdint>
#include <vector>

#include "foam/bubble_store.h"
#include "foam/foam_params.h"
#include "foam/foam_topology.h"
#include "foam/neighbours.h"

namespace spume::foam {

/// Volume [m^3] of a ball of `radius` [m].
double ballVolume(double radius);

/// Radius of the ball that holds `gas` alone [m].
double gasRadius(double gas);

/// Moves volumes towards the gas at the start of a step, by the share 1 - exp(-gamma dt) of what is missing,
/// r <= limit r0. relax: each cell by itself, r *= (V0 / V)^(share / 3). newton: only balls that are hidden,
/// see projectVolumes. Copies volumes and hidden flags into the store and flags the clamped. A hidden bubble
/// has no volume to correct: its ball returns to r0 at the same rate. Deviation: [Busaryev 2012, 5.2]
/// multiplies by 1 + gamma ((V0/V)^(1/3) - 1) dt, which depends on dt and overshoots.
void correctVolumes(const FoamParams& params, const FoamTopology& topology, double dt, BubbleStore& bubbles);

/// Whether the volumes are held in full, at the end of every step: newton, unless its rate is 0.
bool holdsVolumes(const FoamParams& params);

/// Copies volumes and hidden flags into the store.
void noteVolumes(const FoamTopology& topology, BubbleStore& bubbles);

/// Rows of the bubbles whose noted volume is off by more than `tolerance` x V0: neither hidden nor clamped.
std::vector<std::int32_t> cellsOff(const BubbleStore& bubbles, double tolerance);

/// One Newton step of all radii together, by the derivatives of the volumes: what one cell gains its
/// neighbours do not lose. r0 <= r <= limit r0; flags the clamped, which stay as they are while they lack
/// gas, so that their neighbours come to hold theirs. `fixed`: rows whose balls stay as they are; empty where
/// none is; `neighbours` of the topology. Converges in a few steps, each after measuring anew. Deviation:
/// [Busaryev 2012, 5.2] lets the volumes of moving bubbles lag; held in full they make a foam stiffer, which
/// forces/volume_response brings into the implicit step.
void projectVolumes(const FoamParams& params, const FoamTopology& topology, const Neighbours& neighbours,
                    const std::vector<char>& fixed, BubbleStore& bubbles);

}  // namespace spume::foam
