#pragma once

#include <string>
#include <vector>

#include "coupling/errors.h"
#include "coupling/scene.h"

namespace spume::coupling {

/// A value put in place of the file's. A value that is no TOML is taken as a string, so that shells need no
/// second pair of quotes.
struct Override {
  std::string key;               ///< "table.key", or "array.0.key" for an item that the file holds
  std::string value;             ///< as TOML writes it
  std::string option = "--set";  ///< of the command line that gives it, for messages

  std::string text() const { return option + " " + key + "=" + value; }
};
using Overrides = std::vector<Override>;

/// Reads a scene file; where it gives no name, the scene takes the file's. `overrides` are applied as if
/// written in it (the command line's --set). Throws SceneError or FileError.
Scene readScene(const std::string& path, const Overrides& overrides = {});

/// The scene with every value written out, as TOML that reads back to the same scene.
std::string writeScene(const Scene& scene);

/// Documentation of every key, from the table the reader uses: key, type, default, range, unit, meaning.
std::string describeSceneKeys();

}  // namespace spume::coupling
