#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "foam/bubble_store.h"

namespace spume::coupling {

/// One bubble as both files hold it.
struct BubbleRecord {
  double position[3];
  float velocity[3];
  float radius = 0, age = 0, gas = 0, wetness = 0;
  std::int64_t id = 0;
  std::int32_t type = 0;
};

/// The store that `records` describe, ordered by id. Throws SceneError, naming `path`: an id negative or
/// twice, an unknown type.
foam::BubbleStore storeOf(std::vector<BubbleRecord> records, const std::string& path);

}  // namespace spume::coupling
