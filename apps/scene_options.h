#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "coupling/scene_toml.h"

namespace spume::apps {

/// The scene argument and the options that change it, shared by the verbs that read scenes.
struct SceneOptions {
  std::string path;
  std::string frames, resolution, seed, quality;  ///< as typed; empty: the scene's own
  std::vector<std::string> set;                   ///< "table.key=value"

  /// Declares the options on a verb.
  void addTo(CLI::App& verb);
  /// The scene with everything applied, in the order --quality, --set, then the named options.
  /// Throws coupling::SceneError or coupling::FileError.
  coupling::Scene read() const;
};

}  // namespace spume::apps
