#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace spume::foam {

/// Bits of a cell coordinate in a key. Coordinates wrap after 2^19 cells, which only adds candidates to
/// reject.
inline constexpr int kCellAxisBits = 19;

/// Spreads the lowest 19 bits of `v` to every third bit; three of them, shifted by 0, 1 and 2, make a Morton
/// code.
inline std::uint64_t spreadCellBits(std::int64_t coordinate) {
  std::uint64_t v = static_cast<std::uint64_t>(coordinate) & ((1ull << kCellAxisBits) - 1);
  v = (v | v << 32) & 0x1f00000000ffffull;
  v = (v | v << 16) & 0x1f0000ff0000ffull;
  v = (v | v << 8) & 0x100f00f00f00f00full;
  v = (v | v << 4) & 0x10c30c30c30c30c3ull;
  return (v | v << 2) & 0x1249249249249249ull;
}

/// Cell coordinate of x [m] on a grid with cells of `size` [m]; saturates far beyond any simulation.
inline std::int64_t cellCoordinate(double x, double size) {
  constexpr double kFarthest = 0x1p60;
  return static_cast<std::int64_t>(std::floor(std::clamp(x / size, -kFarthest, kFarthest)));
}

/// From the key of a cell to the run of sorted items that lie in it: open addressing, at most half full.
class CellHash {
 public:
  struct Run {
    std::uint64_t key = ~0ull;
    std::int32_t begin = 0, end = 0;
  };

  CellHash() : runs_(2) {}
  /// `sorted`: keys (below 2^64 - 1) in ascending order with anything beside them.
  template <typename Item>
  explicit CellHash(const std::vector<std::pair<std::uint64_t, Item>>& sorted)
      : runs_(std::bit_ceil(2 * sorted.size() + 2)) {
    for (std::size_t begin = 0, end = 0; begin < sorted.size(); begin = end) {
      const std::uint64_t key = sorted[begin].first;
      while (end < sorted.size() && sorted[end].first == key) ++end;
      runs_[slotOf(key)] = {key, static_cast<std::int32_t>(begin), static_cast<std::int32_t>(end)};
    }
  }

  /// The items in the cell; an empty run if there are none.
  const Run& operator[](std::uint64_t key) const { return runs_[slotOf(key)]; }

 private:
  std::size_t slotOf(std::uint64_t key) const {
    std::size_t slot = (key * 0x9e3779b97f4a7c15ull) >> 20 & (runs_.size() - 1);
    while (runs_[slot].key != key && runs_[slot].key != ~0ull) slot = (slot + 1) & (runs_.size() - 1);
    return slot;
  }

  std::vector<Run> runs_;
};

}  // namespace spume::foam
