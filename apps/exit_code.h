#pragma once

#include <exception>

namespace spume::apps {

/// What the program tells its caller; scripts and batch systems rely on these numbers.
enum ExitCode : int {
  kDone = 0,
  kUsage = 2,          ///< wrong command line, or wrong content of a scene or input file
  kFailed = 3,         ///< a check failed or the simulation diverged
  kInputOutput = 4,    ///< a path that cannot be read or written, a full disk
  kOutOfTime = 75,     ///< stopped by --max-wall after a checkpoint: run the same command again
  kInterrupted = 130,  ///< SIGINT, after a checkpoint
  kTerminated = 143,   ///< SIGTERM, after a checkpoint
};

/// The code of a verb that ended with this error.
ExitCode exitCodeOf(const std::exception& error);

}  // namespace spume::apps
