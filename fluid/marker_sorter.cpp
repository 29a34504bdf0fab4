#include <algorithm>
#include <cmath>

#include "fluid/marker_chunks.h"
#include "fluid/marker_particles.h"
#include "fluid/parallel.h"

namespace spume::fluid {

std::int32_t MarkerSorter::cellNumber(float x, float y, float z) const {
  const auto cell = [](float value, int n) { return std::clamp(static_cast<int>(value), 0, n - 1); };
  return (cell(x, cells_.x()) * cells_.y() + cell(y, cells_.y())) * cells_.z() + cell(z, cells_.z());
}

namespace {

/// On its own so that it vectorises.
[[gnu::noinline]] int countRemoved(int count, const float* __restrict x) {
  int removed = 0;
  for (int n = 0; n < count; ++n) removed += x[n] != x[n] ? 1 : 0;
  return removed;
}

}  // namespace

void MarkerSorter::compact(MarkerSet& markers) {
  const std::size_t count = markers.size();
  gone_.resize((count + kMarkerChunk - 1) / kMarkerChunk);
  forEachMarkerChunk(count, [&](std::size_t first, std::size_t last) {
    std::vector<std::size_t>& gone = gone_[first / kMarkerChunk];
    gone.clear();
    if (countRemoved(static_cast<int>(last - first), markers.x.data() + first) == 0) return;
    for (std::size_t n = first; n < last; ++n)
      if (std::isnan(markers.x[n])) gone.push_back(n);
  });
  std::size_t end = count;  // from the last hole on, so that the marker before `end` is none
  for (auto chunk = gone_.rbegin(); chunk != gone_.rend(); ++chunk)
    for (auto hole = chunk->rbegin(); hole != chunk->rend(); ++hole)
      if (--end != *hole) markers.forEachColumn([&](auto& column) { column[*hole] = column[end]; });
  if (end < count) markers.resize(end);
}

void MarkerSorter::sort(MarkerSet& markers) {
  const std::size_t count = markers.size();
  const std::int32_t cells = cells_.prod();
  constexpr std::int32_t kGone = -1;
  cellOf_.resize(count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t n) {
    const bool gone = std::isnan(markers.x[n]);
    cellOf_[n] = gone ? kGone : cellNumber(markers.x[n], markers.y[n], markers.z[n]);
  });
  cellStart_.assign(cells + 1, 0);
  for (const std::int32_t cell : cellOf_)
    if (cell != kGone) ++cellStart_[cell + 1];
  for (std::int32_t cell = 0; cell < cells; ++cell) cellStart_[cell + 1] += cellStart_[cell];
  order_.resize(cellStart_[cells]);
  next_.assign(cellStart_.begin(), cellStart_.end() - 1);
  for (std::size_t n = 0; n < count; ++n)
    if (cellOf_[n] != kGone) order_[next_[cellOf_[n]]++] = static_cast<std::int32_t>(n);
  permute(markers);
}

void MarkerSorter::permute(MarkerSet& markers) {
  const auto reorder = [&](auto& column, auto& scratch) {
    scratch.resize(order_.size());
    forEachMarkerChunk(order_.size(), [&](std::size_t first, std::size_t last) {
      for (std::size_t n = first; n < last; ++n) scratch[n] = column[order_[n]];
    });
    column.swap(scratch);
  };
  for (std::vector<float>* column : {&markers.x, &markers.y, &markers.z, &markers.radius, &markers.gas})
    reorder(*column, column_);
  reorder(markers.escaped, flags_);
}

}  // namespace spume::fluid
