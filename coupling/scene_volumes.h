#pragma once

#include "coupling/scene.h"

namespace spume::coupling {

/// Share of the domain that is liquid at the start, 0..1, to about 1e-3 (from a lattice of points).
double initialWetShare(const Scene& scene);

/// Volume [m^3] all inflows have poured at time t [s].
double pouredUntil(const Scene& scene, double t);

}  // namespace spume::coupling
