#pragma once

#include "coupling/distance_field.h"
#include "coupling/scene.h"

namespace spume::coupling {

/// Signed distance [m] to a solid kept in a file, < 0 inside, sampled twice a cell of edge `dx` [m] and some
/// cells round it; a hollow without an opening counts as solid. A mesh must be closed. Throws FileError
/// (unreadable) or SceneError (a mesh that leaks, naming the edge; a VDB without a level set).
DistanceField distanceFromFile(const ShapeSpec& shape, double dx);

}  // namespace spume::coupling
