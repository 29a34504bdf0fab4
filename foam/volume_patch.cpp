#include "foam/volume_patch.h"

#include "foam/volume_correction.h"

namespace spume::foam {
namespace {

/// Newton steps at most: a cell covered all but wholly grows by a quarter in each.
constexpr int kPasses = 10;
/// Patches at most, each around the cells that the last one has disturbed. These are few and hardly off.
constexpr int kPatches = 4;

}  // namespace

void VolumePatch::settle(const FoamParams& params, const std::vector<std::int32_t>& off,
                         const Neighbours& neighbours, const std::vector<NearWalls>& walls,
                         BubbleStore& bubbles) {
  std::vector<std::int32_t> left = off;
  for (int patch = 0; patch < kPatches && !left.empty(); ++patch) {
    choose(left, neighbours, bubbles.size());
    gather(walls, bubbles);
    correct(params);
    giveBack(bubbles);
    left = cellsOffIn(watched, params.volumeTolerance);
  }
}

void VolumePatch::choose(const std::vector<std::int32_t>& off, const Neighbours& neighbours,
                         std::size_t bubbles) {
  ring_.assign(bubbles, elsewhere);
  std::vector<std::int32_t> inner = off, outer;
  const auto take = [&](const std::vector<std::int32_t>& from, Ring ring) {
    outer.clear();
    for (const std::int32_t i : from)
      for (std::int32_t e = neighbours.start[i]; e < neighbours.start[i + 1]; ++e)
        if (const std::int32_t other = neighbours.other[e]; ring_[other] == elsewhere)
          ring_[other] = ring, outer.push_back(other);
  };
  for (const std::int32_t i : off) ring_[i] = corrected;
  for (const Ring ring : {corrected, watched, cutting}) take(inner, ring), inner.swap(outer);
  rows_.clear(), fixed_.clear();
  for (std::size_t i = 0; i < bubbles; ++i) {
    if (ring_[i] == elsewhere) continue;
    rows_.push_back(static_cast<std::int32_t>(i)), fixed_.push_back(ring_[i] != corrected);
  }
}

void VolumePatch::gather(const std::vector<NearWalls>& walls, const BubbleStore& bubbles) {
  part_.gather(bubbles, rows_);
  walls_.clear();
  if (walls.empty()) return;
  for (const std::int32_t i : rows_) walls_.push_back(walls[i]);
}

void VolumePatch::measure() {
  cells_.compute(part_, walls_, topology_);
  noteVolumes(topology_, part_);
}

/// Leaves the patch as measured with its last radii.
void VolumePatch::correct(const FoamParams& params) {
  measure();
  for (int pass = 0; pass < kPasses && !cellsOffIn(corrected, params.volumeTolerance).empty(); ++pass) {
    projectVolumes(params, topology_, fixed_, part_);
    measure();
  }
}

void VolumePatch::giveBack(BubbleStore& bubbles) const {
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    bubbles.radius[rows_[k]] = part_.radius[k];
    bubbles.clamped[rows_[k]] = part_.clamped[k];
  }
}

/// Rows of all bubbles; of the last ring's cells nothing is known, they are cut by bubbles that are not here.
std::vector<std::int32_t> VolumePatch::cellsOffIn(Ring last, double tolerance) const {
  std::vector<std::int32_t> rows;
  for (const std::int32_t k : cellsOff(part_, tolerance))
    if (ring_[rows_[k]] <= last) rows.push_back(rows_[k]);
  return rows;
}

}  // namespace spume::foam
