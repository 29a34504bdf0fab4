#pragma once

#include <limits>

#include "coupling/distance_field.h"
#include "coupling/scene.h"

namespace spume::coupling {

/// Signed distance [m] to a solid kept in a file, < 0 inside, sampled twice a cell of edge `dx` [m] and some
/// cells round it; a hollow without an opening counts as solid. A mesh must be closed. Throws FileError
/// (unreadable) or SceneError (a mesh that leaks, naming the edge; a VDB without a level set; a solid longer
/// than `longest` [m], as one in another unit is).
DistanceField distanceFromFile(const ShapeSpec& shape, double dx,
                               double longest = std::numeric_limits<double>::infinity());

}  // namespace spume::coupling
