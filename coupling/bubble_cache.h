#pragma once

#include <string>

#include "coupling/liquid_cache.h"
#include "foam/bubble_store.h"

namespace spume::coupling {

/// The two bubble files hold the same attributes: P [m], v [m/s], pscale = radius [m], id, age [s],
/// type (0 liquid, 1 surface, 2 air), vol = gas [m^3], wetness, flags (1 hidden, 2 at its radius limit, 3
/// both). Numbers are float, as their readers expect; `id` is int64 in VDB and double in PLY, which has no
/// 64-bit integer (exact to 2^53). Files without flags are read, too: none is set.

/// Writes bubbles.####.vdb: one PointDataGrid named `bubbles`. `voxel` [m] only sets its bucketing. Atomic.
/// Throws FileError.
void writeBubblesVdb(const std::string& path, const foam::BubbleStore& bubbles, const FrameStamp& stamp,
                     double voxel);

/// Writes bubbles.####.ply: binary little endian, one vertex a bubble. Atomic. Throws FileError.
void writeBubblesPly(const std::string& path, const foam::BubbleStore& bubbles, const FrameStamp& stamp);

struct BubbleFrame {
  FrameStamp stamp;
  foam::BubbleStore bubbles;  ///< columns that are not cached hold their defaults; ordered by id
};

/// Throw FileError (cannot be opened) or SceneError (not such a file: what is missing).
BubbleFrame readBubblesVdb(const std::string& path);
BubbleFrame readBubblesPly(const std::string& path);

}  // namespace spume::coupling
