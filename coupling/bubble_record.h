#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "foam/bubble_store.h"

namespace spume::coupling {

/// Bits of `flags`: what befell the bubble's cell at the last update of the geometry.
inline constexpr std::int32_t kHiddenFlag = 1;   ///< another ball swallows it: it has no cell
inline constexpr std::int32_t kClampedFlag = 2;  ///< its radius is at its limit, its cell lacks gas

/// One bubble as both files hold it.
struct BubbleRecord {
  double position[3];
  float velocity[3];
  float radius = 0, age = 0, gas = 0, wetness = 0;
  std::int64_t id = 0;
  std::int32_t type = 0;
  std::int32_t flags = 0;  ///< kHiddenFlag, kClampedFlag
};

/// `flags` of bubble n.
std::int32_t flagsOf(const foam::BubbleStore& bubbles, std::size_t n);

/// The store that `records` describe, ordered by id. Throws SceneError, naming `path`: an id negative or
/// twice, an unknown type or flag.
foam::BubbleStore storeOf(std::vector<BubbleRecord> records, const std::string& path);

}  // namespace spume::coupling
