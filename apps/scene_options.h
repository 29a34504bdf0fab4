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

  /// Declares the scene and the options on a verb.
  void addTo(CLI::App& verb);
  /// Declares --frames, --seed and --set alone; `keys` says which keys may be set.
  void addChangesTo(CLI::App& verb, const std::string& keys);
  /// The scene with everything applied, in the order --quality, --set, the named options, then `further`.
  /// Throws coupling::SceneError or coupling::FileError.
  coupling::Scene read(const coupling::Overrides& further = {}) const;
  /// Throws coupling::SceneError if an option sets the same key.
  void requireNew(const coupling::Override& further) const;

 private:
  coupling::Overrides given() const;
};

}  // namespace spume::apps
