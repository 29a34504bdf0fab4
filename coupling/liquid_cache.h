#pragma once

#include <string>

#include "coupling/errors.h"
#include "fluid/liquid_state.h"
#include "fluid/solid_boundary.h"

namespace spume::coupling {

/// When a cached frame belongs.
struct FrameStamp {
  int frame = 0;
  double time = 0;  ///< [s]
  double fps = 30;
};

struct LiquidCacheOptions {
  bool staggeredVelocity = false;  ///< faces as the solver has them instead of cell centres
  bool solid = true;               ///< write `solid`, the distance to solids and walls
};

/// A liquid read back. Velocity is known in the liquid and near its surface; grad p and markers are not
/// cached.
struct LiquidFrame {
  FrameStamp stamp;
  fluid::LiquidState liquid;  ///< phi clamped to the narrow band [m]
  fluid::DenseField<float>
      psi;                ///< distance to solids and walls [m]; to the box of the grid if none was cached
  bool hasSolid = false;  ///< psi was cached
};

/// Writes liquid.####.vdb: `surface`, `vel` and, if asked, `solid` (see fluid/vdb_grids.h), each with the
/// metadata frame, time, fps. Atomic. Throws FileError.
void writeLiquidFrame(const std::string& path, const fluid::LiquidState& liquid,
                      const fluid::SolidBoundary& solids, const FrameStamp& stamp,
                      const LiquidCacheOptions& options = {});

/// Reads what writeLiquidFrame wrote. Throws FileError (cannot be opened, no VDB) or SceneError (grids
/// missing).
LiquidFrame readLiquidFrame(const std::string& path);

}  // namespace spume::coupling
