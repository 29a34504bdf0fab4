#pragma once

#include <string>

#include "apps/wedge/wedge.h"

namespace spume::apps {

/// The second line of every script begins so: it tells a sweep's files from others.
inline constexpr char kWedgeMark[] = "# Written by spume wedge";

/// Scene of a variant, every value resolved, in its folder. `spume run` writes its own scene.toml beside it.
inline constexpr char kVariantScene[] = "variant.toml";

/// A script that runs the variants one after the other in the folder it lies in. A variant that fails does
/// not hold up the others; the script then ends with the code of the first that did. Interruptions and the
/// end of --max-wall (75, 130, 143) end it at once. `program`: the spume to run unless $SPUME names another.
std::string commandScript(const Wedge& wedge, const std::string& program);

/// What a job array asks for.
struct SlurmRequest {
  std::string program;     ///< absolute path of spume
  std::string folder;      ///< absolute path of the sweep
  double maxWall;          ///< of a job, handed to `spume run` [s]
  int threads;             ///< of a job
  double memoryBytes = 0;  ///< of a job, as estimated
};

/// A batch script with one task a variant. `spume run` stops a job in time, with a checkpoint and exit code
/// 75; the task is then queued again and goes on. The scheduler's own limit lies kWallMargin later.
std::string slurmScript(const Wedge& wedge, const SlurmRequest& request);

/// For the step at the end of a job's time, its checkpoint and a slow start [s].
inline constexpr double kWallMargin = 600;

/// wedge.csv: folder and values of every variant.
std::string wedgeTable(const Wedge& wedge);

}  // namespace spume::apps
