#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "coupling/scene.h"

namespace spume::apps {

/// The options of a verb that runs a scene into a folder.
struct SessionArguments {
  std::string output, maxWall;  ///< as typed; empty: the verb's default, no limit
  int threads = 0;              ///< 0: one per core
  bool restart = false, noPreview = false;

  /// Declares them on a verb; `defaultFolder` is for the help text.
  void addTo(CLI::App& verb, const std::string& defaultFolder);
  /// Runs `scene` into `output`, or into `defaultFolder`, and returns the exit code. Throws as runSession
  /// does.
  int run(coupling::Scene scene, const std::string& defaultFolder) const;
};

}  // namespace spume::apps
