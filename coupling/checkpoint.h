#pragma once

#include <optional>
#include <string>
#include <vector>

#include "coupling/errors.h"
#include "coupling/simulation.h"

namespace spume::coupling {

/// Writes `folder`/checkpoint.######.bin (the number is the frame): header, resolved scene, SIMD path, every
/// column bit for bit, checksum. Atomic; afterwards only the two newest remain. Creates the folder. Throws
/// FileError.
void writeCheckpoint(const std::string& folder, const Scene& scene, const SimulationState& state);

struct LoadedCheckpoint {
  std::string path;
  SimulationState state;
  std::vector<std::string> warnings;  ///< newer files that were damaged, with what is wrong with each
};

/// The newest checkpoint of `scene` that is whole; nothing if the folder holds none. Throws SceneError,
/// naming every difference, if it belongs to another scene, seed or SIMD path, and FileError if all are
/// damaged. Keys that do not change the motion may differ: [output], [camera], [look], scene.name,
/// scene.title, time.frames.
std::optional<LoadedCheckpoint> readNewestCheckpoint(const std::string& folder, const Scene& scene);

/// One line per key whose value differs between two resolved scenes (texts of writeScene), those that do not
/// change the motion left out: "foam.wetness = 0.4 there, 0.5 here".
std::vector<std::string> sceneDifferences(const std::string& there, const std::string& here);

}  // namespace spume::coupling
