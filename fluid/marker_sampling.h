#pragma once

#include <array>
#include <cstdint>
#include <cstring>

#include "fluid/marker_chunks.h"
#include "fluid/marker_set.h"
#include "fluid/sampling.h"
#include "fluid/wall_sides.h"

namespace spume::fluid {

/// One number per marker of a chunk.
struct alignas(64) MarkerValues : std::array<float, kMarkerChunk> {};
struct alignas(64) MarkerCells : std::array<std::int32_t, kMarkerChunk> {};

/// Trilinear values of a cell-centred field at the markers [first, last), which lie in the grid:
/// `values[n - first]` belongs to marker n.
void sampleAtMarkers(const FieldView& field, const MarkerSet& markers, std::size_t first, std::size_t last,
                     MarkerValues& values);

/// The same for phi beside thin walls: a marker sees what is on the side of its cell.
void sampleAtMarkers(const DenseField<float>& phi, const WallSides& sides, const MarkerSet& markers,
                     std::size_t first, std::size_t last, MarkerValues& values);

/// phi and its gradient per cell at a point of cell `c` [cell units] as its side of thin walls has them;
/// `view` is that of phi.
ValueAndGradient sampleOnSide(const DenseField<float>& phi, const FieldView& view, const WallSides& sides,
                              const Eigen::Vector3i& c, const Eigen::Vector3f& x);

/// Offsets of the cells that hold the markers [first, last) in a field with the strides of `field`. A marker
/// on the high side of the grid belongs to the last cell.
template <typename T>
void findMarkerCells(const DenseField<T>& field, const MarkerSet& markers, std::size_t first,
                     std::size_t last, MarkerCells& cells);
extern template void findMarkerCells(const DenseField<float>&, const MarkerSet&, std::size_t, std::size_t,
                                     MarkerCells&);
extern template void findMarkerCells(const DenseField<std::int32_t>&, const MarkerSet&, std::size_t,
                                     std::size_t, MarkerCells&);

/// Calls body(n) for every marker in [first, last) that is flagged as escaped, in order; few are.
template <typename Body>
void forEachEscaped(const MarkerSet& markers, std::size_t first, std::size_t last, const Body& body) {
  constexpr std::size_t kWord = sizeof(std::uint64_t);  // flags looked at together
  const auto look = [&](std::size_t from, std::size_t to) {
    for (std::size_t n = from; n < to; ++n)
      if (markers.escaped[n]) body(n);
  };
  std::size_t n = first;
  for (; n + kWord <= last; n += kWord) {
    std::uint64_t flags;
    std::memcpy(&flags, markers.escaped.data() + n, kWord);
    if (flags != 0) look(n, n + kWord);
  }
  look(n, last);
}

/// Flags the markers [first, last) whose distance into their own side, toSide times `values` [cells], is less
/// than minus their radius.
void flagEscapedMarkers(const MarkerValues& values, float toSide, std::size_t first, std::size_t last,
                        MarkerSet& markers);

}  // namespace spume::fluid
