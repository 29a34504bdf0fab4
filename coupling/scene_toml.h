#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "coupling/scene.h"

namespace spume::coupling {

/// Wrong content of a scene file. `what()` is one message: file:line:column, the key, its value, the allowed range
/// with its unit and, for an unknown key, the nearest valid one.
class SceneError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A file that cannot be read or written. `what()` names the path and the system's reason.
class FileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

using Overrides = std::vector<std::pair<std::string, std::string>>;   ///< ("table.key", "TOML value")

/// Reads a scene file. `overrides` are applied as if written in it (the command line's --set).
/// Throws SceneError or FileError.
Scene readScene(const std::string& path, const Overrides& overrides = {});

/// The scene with every value written out, as TOML that reads back to the same scene.
std::string writeScene(const Scene& scene);

/// Documentation of every key, from the table the reader uses: key, type, default, range, unit, meaning.
std::string describeSceneKeys();

}  // namespace spume::coupling
