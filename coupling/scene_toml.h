#pragma once

#include <string>
#include <utility>
#include <vector>

#include "coupling/errors.h"
#include "coupling/scene.h"

namespace spume::coupling {

/// ("table.key", "TOML value"), or ("array.0.key", ...) for an item that the file holds. A value that is no
/// TOML is taken as a string, so that shells need no second pair of quotes.
using Overrides = std::vector<std::pair<std::string, std::string>>;

/// Reads a scene file; where it gives no name, the scene takes the file's. `overrides` are applied as if
/// written in it (the command line's --set). Throws SceneError or FileError.
Scene readScene(const std::string& path, const Overrides& overrides = {});

/// The scene with every value written out, as TOML that reads back to the same scene.
std::string writeScene(const Scene& scene);

/// Documentation of every key, from the table the reader uses: key, type, default, range, unit, meaning.
std::string describeSceneKeys();

}  // namespace spume::coupling
