#include "fluid/split_cells.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include "fluid/cut_fractions.h"
#include "fluid/parallel.h"

namespace spume::fluid {
namespace {

/// A value that counts as solid and moves no crossing: a corner that is shut has solid neighbours only.
constexpr double kShut = -1;

/// Values at the corners of a cell; bit a of a corner's number tells its side along axis a.
using Corners = std::array<double, 8>;

Corners cornersOf(const DenseField<float>& nodePsi, int i, int j, int k) {
  Corners corner;
  for (int n = 0; n < 8; ++n) corner[n] = nodePsi(i + (n & 1), j + (n >> 1 & 1), k + (n >> 2));
  return corner;
}

/// The free corners joined to corner `start` by free edges, as bits.
int partOf(const Corners& corner, int start) {
  int part = 1 << start;
  for (int grown = 0; grown != part;) {
    grown = part;
    for (int n = 0; n < 8; ++n)
      for (int a = 0; a < 3; ++a)
        if ((part >> n & 1) && corner[n ^ (1 << a)] > 0) part |= 1 << (n ^ (1 << a));
  }
  return part;
}

double opening(const Corners& corner, int part) {
  double sum = 0;
  for (int n = 0; n < 8; ++n)
    if (part >> n & 1) sum += corner[n];
  return sum;
}

/// The free corners of a cell that do not belong to its largest part, as bits.
std::uint8_t shutCorners(const Corners& corner) {
  int free = 0, kept = 0;
  for (int n = 0; n < 8; ++n) free |= (corner[n] > 0) << n;
  double most = 0;
  for (int rest = free; rest;) {
    int start = 0;
    while (!(rest >> start & 1)) ++start;
    const int part = partOf(corner, start);
    rest &= ~part;
    const double size = opening(corner, part);
    if (size > most) most = size, kept = part;
  }
  return static_cast<std::uint8_t>(free & ~kept);
}

/// Number of the corner of a cell at (u, v) on its face across `axis` on the low or high side.
int faceCorner(int axis, int side, int u, int v) {
  return side << axis | u << (axis + 1) % 3 | v << (axis + 2) % 3;
}

void narrowFace(int axis, const Eigen::Vector3i& face, const DenseField<std::uint8_t>& shut,
                SolidBoundary& boundary) {
  const Eigen::Vector3i u = Eigen::Vector3i::Unit((axis + 1) % 3), v = Eigen::Vector3i::Unit((axis + 2) % 3);
  const int above = shut(face), below = shut(face - Eigen::Vector3i::Unit(axis));  // 0 in the ghosts
  if (!(above | below)) return;
  const auto value = [&](int p, int q) {
    const bool closed = above >> faceCorner(axis, 0, p, q) & 1 || below >> faceCorner(axis, 1, p, q) & 1;
    return closed ? kShut : static_cast<double>(boundary.nodePsi(face + p * u + q * v));
  };
  const auto open = static_cast<float>(squareFraction({value(0, 0), value(1, 0), value(1, 1), value(0, 1)}));
  float& fraction = boundary.open[axis](face);
  fraction = open < kMinOpenFraction ? 0 : std::min(fraction, open);
}

void narrowCell(int i, int j, int k, int shut, SolidBoundary& boundary) {
  float& fraction = boundary.cellFraction(i, j, k);
  if (!boundary.hasOpenFace(i, j, k)) {
    fraction = 0;
  } else if (shut) {
    Corners corner = cornersOf(boundary.nodePsi, i, j, k);
    for (int n = 0; n < 8; ++n)
      if (shut >> n & 1) corner[n] = kShut;
    fraction = static_cast<float>(cubeFraction(corner));
  }
}

}  // namespace

void closeSplitCells(const Eigen::Vector3i& cells, SolidBoundary& boundary) {
  DenseField<std::uint8_t>& shut = boundary.shut;
  forEachCell(
      cells, [&](int i, int j, int k) { shut(i, j, k) = shutCorners(cornersOf(boundary.nodePsi, i, j, k)); });
  for (int a = 0; a < 3; ++a)
    forEachCell(boundary.open[a].size(), [&](int i, int j, int k) {
      narrowFace(a, {i, j, k}, shut, boundary);
    });
  forEachCell(cells, [&](int i, int j, int k) { narrowCell(i, j, k, shut(i, j, k), boundary); });
}

}  // namespace spume::fluid
