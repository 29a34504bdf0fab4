#include <algorithm>
#include <cmath>
#include <utility>

#include "fluid/marker_chunks.h"
#include "fluid/marker_particles.h"
#include "fluid/parallel.h"

namespace spume::fluid {

std::int32_t MarkerSorter::cellNumber(float x, float y, float z) const {
  const auto cell = [](float value, int n) { return std::clamp(static_cast<int>(value), 0, n - 1); };
  return (cell(x, cells_.x()) * cells_.y() + cell(y, cells_.y())) * cells_.z() + cell(z, cells_.z());
}

namespace {

constexpr std::int32_t kGone = -1;  // cell of a removed marker

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

/// Counts the markers of every slab of cells (fixed x), by chunk of markers.
void MarkerSorter::countInSlabs(const MarkerSet& markers) {
  const std::size_t count = markers.size(), slabs = cells_.x();
  const std::int32_t perSlab = cells_.y() * cells_.z();
  resizeWithRoom(cellOf_, count);
  place_.assign((count + kMarkerChunk - 1) / kMarkerChunk * slabs, 0);
  forEachMarkerChunk(count, [&](std::size_t first, std::size_t last) {
    std::int32_t* inSlab = &place_[first / kMarkerChunk * slabs];
    for (std::size_t n = first; n < last; ++n) {
      const bool gone = std::isnan(markers.x[n]);
      cellOf_[n] = gone ? kGone : cellNumber(markers.x[n], markers.y[n], markers.z[n]);
      if (!gone) ++inSlab[cellOf_[n] / perSlab];
    }
  });
}

/// Turns the counts into places: those of one slab follow each other, within it those of one chunk. Returns
/// where each slab begins, and the total.
std::vector<std::int32_t> MarkerSorter::placeSlabs() {
  const std::size_t slabs = cells_.x();
  std::vector<std::int32_t> start(slabs + 1);
  std::int32_t place = 0;
  for (std::size_t slab = 0; slab < slabs; ++slab) {
    start[slab] = place;
    for (std::size_t at = slab; at < place_.size(); at += slabs) place += std::exchange(place_[at], place);
  }
  start[slabs] = place;
  return start;
}

/// Sorts the markers of a slab, given in their order, by cell.
void MarkerSorter::sortSlab(int slab, std::int32_t begin, std::int32_t end) {
  const std::int32_t perSlab = cells_.y() * cells_.z();
  std::int32_t* start = &cellStart_[slab * perSlab];
  const std::int32_t firstCell = slab * perSlab;
  std::fill_n(start, perSlab, 0);
  for (std::int32_t n = begin; n < end; ++n) ++start[cellOf_[bySlab_[n]] - firstCell];
  std::int32_t place = begin;
  for (std::int32_t cell = 0; cell < perSlab; ++cell) {
    next_[firstCell + cell] = place;
    place += std::exchange(start[cell], place);
  }
  for (std::int32_t n = begin; n < end; ++n) order_[next_[cellOf_[bySlab_[n]]]++] = bySlab_[n];
}

void MarkerSorter::sort(MarkerSet& markers) {
  countInSlabs(markers);
  const std::vector<std::int32_t> slabStart = placeSlabs();
  const std::size_t slabs = cells_.x();
  const std::int32_t perSlab = cells_.y() * cells_.z(), cells = cells_.prod();
  resizeWithRoom(bySlab_, slabStart.back());
  resizeWithRoom(order_, slabStart.back());
  forEachMarkerChunk(markers.size(), [&](std::size_t first, std::size_t last) {
    std::int32_t* place = &place_[first / kMarkerChunk * slabs];
    for (std::size_t n = first; n < last; ++n)
      if (cellOf_[n] != kGone) bySlab_[place[cellOf_[n] / perSlab]++] = static_cast<std::int32_t>(n);
  });
  cellStart_.resize(cells + 1);
  next_.resize(cells);
  tbb::parallel_for(0, cells_.x(), [&](int slab) { sortSlab(slab, slabStart[slab], slabStart[slab + 1]); });
  cellStart_[cells] = slabStart.back();
  permute(markers);
}

void MarkerSorter::permute(MarkerSet& markers) {
  const auto reorder = [&](auto& column, auto& scratch) {
    resizeWithRoom(scratch, order_.size());
    forEachMarkerChunk(order_.size(), [&](std::size_t first, std::size_t last) {
      for (std::size_t n = first; n < last; ++n) scratch[n] = column[order_[n]];
    });
    column.swap(scratch);
  };
  for (LargeVector<float>* column : {&markers.x, &markers.y, &markers.z, &markers.radius, &markers.gas})
    reorder(*column, column_);
  reorder(markers.escaped, flags_);
}

/// The runs of a slab of cells, in the order of the cells.
void MarkerSorter::findRuns(int slab, const MarkerSet& markers, const MarkerSet& added) {
  std::vector<Run>& runs = runs_[slab];
  runs.clear();
  const auto append = [&](bool isNew, std::int32_t n) {
    if (!runs.empty() && runs.back().isNew == isNew && runs.back().end == n)
      ++runs.back().end;
    else
      runs.push_back({isNew, n, n + 1});
  };
  const std::int32_t perSlab = cells_.y() * cells_.z(), count = static_cast<std::int32_t>(added.size());
  std::int32_t next = 0;
  for (std::int32_t cell = slab * perSlab; cell < (slab + 1) * perSlab; ++cell) {
    for (std::int32_t n = cellStart_[cell]; n < cellStart_[cell + 1]; ++n)
      if (!std::isnan(markers.x[n])) append(false, n);
    for (; next < count && cellNumber(added.x[next], added.y[next], added.z[next]) == cell; ++next)
      append(true, next);
  }
}

void MarkerSorter::insert(const std::vector<MarkerSet>& added, MarkerSet& markers) {
  const int slabs = cells_.x();
  runs_.resize(slabs);
  tbb::parallel_for(0, slabs, [&](int slab) { findRuns(slab, markers, added[slab]); });
  std::vector<std::int32_t> start(slabs + 1, 0);
  for (int slab = 0; slab < slabs; ++slab) {
    start[slab + 1] = start[slab];
    for (const Run& run : runs_[slab]) start[slab + 1] += run.end - run.begin;
  }
  const auto string = [&](auto column, auto& scratch) {
    resizeWithRoom(scratch, start[slabs]);
    tbb::parallel_for(0, slabs, [&](int slab) {
      auto to = scratch.begin() + start[slab];
      for (const Run& run : runs_[slab]) {
        const auto from = ((run.isNew ? added[slab] : markers).*column).begin();
        to = std::copy(from + run.begin, from + run.end, to);
      }
    });
    (markers.*column).swap(scratch);
  };
  for (const auto column : {&MarkerSet::x, &MarkerSet::y, &MarkerSet::z, &MarkerSet::radius, &MarkerSet::gas})
    string(column, column_);
  string(&MarkerSet::escaped, flags_);
}

}  // namespace spume::fluid
