#pragma once

#include <string>
#include <vector>

#include "coupling/liquid_cache.h"
#include "fluid/drop.h"

namespace spume::coupling {

/// Drops in flight as points: P [m], v [m/s], pscale = radius of a ball of their volume [m], id, vol [m^3].
/// Numbers are float; `id` is int64 in VDB and double in PLY.

/// Writes drops.####.vdb: one PointDataGrid named `drops`. `voxel` [m] only sets its bucketing. Atomic.
/// Throws FileError.
void writeDropsVdb(const std::string& path, const std::vector<fluid::Drop>& drops, const FrameStamp& stamp,
                   double voxel);

/// Writes drops.####.ply: binary little endian, one vertex a drop. Atomic. Throws FileError.
void writeDropsPly(const std::string& path, const std::vector<fluid::Drop>& drops, const FrameStamp& stamp);

/// Both return the drops by id and throw FileError (cannot be opened) or SceneError (not such a file).
std::vector<fluid::Drop> readDropsVdb(const std::string& path);
std::vector<fluid::Drop> readDropsPly(const std::string& path);

/// Radius of the ball that holds the drop [m].
double radiusOf(const fluid::Drop& drop);

}  // namespace spume::coupling
