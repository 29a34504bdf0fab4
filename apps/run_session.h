#pragma once

#include <optional>
#include <string>

#include "apps/exit_code.h"
#include "apps/stop_request.h"
#include "coupling/scene.h"

namespace spume::apps {

/// What one call of `spume run` does.
struct SessionOptions {
  coupling::Scene scene;
  std::string folder;
  bool restart = false;           ///< start anew even if the folder holds a checkpoint
  int threads = 1;                ///< recorded in run.json
  std::optional<double> maxWall;  ///< [s]
};

/// Runs the scene to its last frame, or until it is asked to stop, with checkpoints on the way. Prints
/// progress. Throws coupling::SceneError and FileError; a divergence is thrown as NumericalFailure. What
/// stops a run on the way leaves a checkpoint, where the disk still takes one.
ExitCode runSession(const SessionOptions& options);

/// Threads that work if nothing else is asked for: one per core, or as many as a tbb::global_control leaves.
int allowedThreads();

/// The same on all of them for a verb that runs many scenes. Throws Stopped if it was interrupted.
void runToTheEnd(const coupling::Scene& scene, const std::string& folder, bool restart);

/// Tells a person that such a verb was stopped and how to go on. Returns the exit code.
int tellStopped(const Stopped& stopped, bool restart);

}  // namespace spume::apps
