#pragma once

#include <vector>

#include "fluid/dense_field.h"
#include "fluid/drop.h"
#include "fluid/grid_spec.h"
#include "fluid/liquid_bodies.h"
#include "fluid/marker_set.h"

namespace spume::fluid {

/// Takes specks out of phi and returns them as drops with their volume and mean velocity, in the order of
/// their bodies, without ids. A speck is a body of at most three cells, all of them barely wet, none with a
/// marker of its own. The grid cannot move it: beneath a lid its faces gain as much speed in a sub-step as
/// they lose to the closed ones above, liquid streams through it from air to air and phi stands still.
/// `bodies` were found from this phi; find them again if any drop comes back.
std::vector<Drop> releaseSpecks(const GridSpec& grid, const LiquidBodies& bodies, const MacVelocity& velocity,
                                const MarkerSet& negative, DenseField<float>& phi);

}  // namespace spume::fluid
