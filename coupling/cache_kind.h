#pragma once

#include <string>

#include "coupling/liquid_cache.h"

namespace spume::coupling {

enum class CacheKind { liquid, bubbles, drops, films };

/// What a cache holds and when it belongs, by the names of its grids or properties: the file may be called
/// anything.
struct CacheLabel {
  CacheKind kind;
  FrameStamp stamp;
};

/// Both read no more than names. Throw FileError (cannot be opened) or SceneError (none of these kinds).
CacheLabel labelOfVdb(const std::string& path);
CacheLabel labelOfPly(const std::string& path);

}  // namespace spume::coupling
