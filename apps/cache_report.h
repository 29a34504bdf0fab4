#pragma once

#include <string>

#include "apps/report.h"

namespace spume::apps {

/// What a cache file holds: when it belongs, and the counts and totals of its liquid, bubbles, drops or
/// films, told apart by their names in the file. Throws coupling::FileError or SceneError.
void describeFile(const std::string& path, Report& report);

/// What a run's folder holds: frames of each kind, bytes of all caches, pictures and checkpoints, and the
/// contents of the last frame, of bubbles and drops from either of their files. Throws as above.
void describeFolder(const std::string& path, Report& report);

}  // namespace spume::apps
