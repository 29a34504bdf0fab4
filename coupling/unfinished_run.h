#pragma once

#include "coupling/run_folder.h"
#include "coupling/scene.h"

namespace spume::coupling {

/// How a run begins in a folder without a checkpoint to go on from.
enum class Beginning {
  afresh,  ///< there are no frames: whatever else an earlier run has left may go
  again,   ///< the same run was killed before its first checkpoint was due: its frames are made again
};

/// What the folder allows. Frames are an earlier run's work and never given up unasked: throws SceneError
/// with the differences where they are another scene's, FileError where they are, or may be, of a run that
/// had a checkpoint.
Beginning beginningIn(const RunFolder& folder, const Scene& scene);

}  // namespace spume::coupling
