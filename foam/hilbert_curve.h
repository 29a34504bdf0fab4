#pragma once

#include <array>
#include <cstdint>

namespace spume::foam {

namespace hilbert {

constexpr std::uint32_t turnedLeft(std::uint32_t corner, std::uint32_t by) {
  return (corner << by | corner >> (3 - by)) & 7;
}

/// For a turn of the curve, 8 (3 entry corner + axis), and an octant added: the next turn, and added to it
/// the octant's place along the curve.
constexpr std::array<std::uint8_t, 192> steps() {
  constexpr std::uint32_t kEntry[8] = {0, 0, 0, 3, 3, 6, 6, 5}, kAxis[8] = {0, 1, 1, 2, 2, 1, 1, 0};
  std::array<std::uint8_t, 192> steps{};
  for (std::uint32_t entry = 0; entry < 8; ++entry)
    for (std::uint32_t axis = 0; axis < 3; ++axis)
      for (std::uint32_t place = 0; place < 8; ++place) {
        const std::uint32_t by = (axis + 1) % 3, octant = turnedLeft(place ^ place >> 1, by) ^ entry;
        const std::uint32_t nextEntry = entry ^ turnedLeft(kEntry[place], by);
        const std::uint32_t nextAxis = (axis + kAxis[place] + 1) % 3;
        steps[8 * (3 * entry + axis) + octant] =
            static_cast<std::uint8_t>(8 * (3 * nextEntry + nextAxis) + place);
      }
  return steps;
}

inline constexpr std::array<std::uint8_t, 192> kSteps = steps();

}  // namespace hilbert

/// Where a cell with a Morton code lies along Hilbert's curve through 2^`levels` cells along an edge. Cells
/// that follow each other share a face, so a piece of the curve is a compact body without leaps. After C.
/// Hamilton, Compact Hilbert Indices, Dalhousie University CS-2006-07: within an octant the curve is the
/// whole one, entered at another corner and along another axis.
constexpr std::uint64_t hilbertPlace(std::uint64_t mortonCode, int levels) {
  std::uint64_t place = 0;
  std::uint32_t turn = 0;
  for (int level = levels - 1; level >= 0; --level) {
    const std::uint32_t step = hilbert::kSteps[turn | (mortonCode >> (3 * level) & 7)];
    place = place << 3 | (step & 7);
    turn = step & ~7u;
  }
  return place;
}

}  // namespace spume::foam
