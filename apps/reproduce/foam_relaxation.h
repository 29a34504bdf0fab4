#pragma once

#include "apps/reproduce/soft_packing.h"

namespace spume::apps {

/// Brings a packing of soft balls to rest by steps of the foam itself, as weightless tangent bubbles that are
/// not held to their volumes: as SoftPacking::relax(), by FoamSolver. The foam knows no periodic box: images
/// of the balls near its sides stand beside it, heavy enough to stay where they are within a step, and follow
/// their balls after it. Returns whether it came to rest. Throws foam::InvalidParameter if cells hold areas,
/// which a foam of balls can not.
bool relaxAsFoam(SoftPacking& packing);

}  // namespace spume::apps
