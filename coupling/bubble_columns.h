#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>

namespace spume::coupling {

/// The columns a file of bubbles may have.
enum BubbleColumn : std::size_t { kId, kX, kY, kZ, kR, kVx, kVy, kVz, kWetness, kBubbleColumns };

inline constexpr std::array<std::string_view, kBubbleColumns> kBubbleColumnName = {
    "id", "x", "y", "z", "r", "vx", "vy", "vz", "wetness"};

/// A bubble's numbers by column; what its file does not give is 0.
using BubbleValues = std::array<double, kBubbleColumns>;

/// The column called `name`, or kBubbleColumns.
inline std::size_t bubbleColumn(std::string_view name) {
  return std::find(kBubbleColumnName.begin(), kBubbleColumnName.end(), name) - kBubbleColumnName.begin();
}

}  // namespace spume::coupling
