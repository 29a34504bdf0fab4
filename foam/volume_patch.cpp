#include "foam/volume_patch.h"

#include "foam/volume_correction.h"

namespace spume::foam {
namespace {

/// Newton steps at most: a cell covered all but wholly grows by a quarter in each.
constexpr int kSteps = 16;

}  // namespace

void VolumePatch::settle(const FoamParams& params, const std::vector<NearWalls>& walls,
                         FoamTopology& topology, Neighbours& neighbours, BubbleStore& bubbles) {
  measurement_.begin(bubbles, walls);
  for (int step = 0; step < kSteps; ++step) {
    const std::vector<std::int32_t> off = cellsOff(bubbles, params.volumeTolerance);
    if (off.empty()) return;
    if (step > 0) neighbours.build(bubbles.size(), topology.overlaps);
    choose(off, neighbours, bubbles.size());
    correct(params, topology, neighbours, bubbles);
    if (changed_.empty()) return;
    measurement_.update(bubbles, walls, changed_, neighbours, topology);
    noteVolumes(topology, bubbles);
  }
}

void VolumePatch::choose(const std::vector<std::int32_t>& off, const Neighbours& neighbours,
                         std::size_t bubbles) {
  ring_.assign(bubbles, elsewhere), place_.assign(bubbles, -1);
  std::vector<std::int32_t> inner = off, outer;
  const auto take = [&](const std::vector<std::int32_t>& from, Ring ring) {
    outer.clear();
    for (const std::int32_t i : from)
      for (std::int32_t e = neighbours.start[i]; e < neighbours.start[i + 1]; ++e)
        if (const std::int32_t other = neighbours.other[e]; ring_[other] == elsewhere)
          ring_[other] = ring, outer.push_back(other);
  };
  for (const std::int32_t i : off) ring_[i] = corrected;
  take(off, corrected);
  inner.insert(inner.end(), outer.begin(), outer.end());
  take(inner, watched);
  rows_.clear(), fixed_.clear();
  for (std::size_t i = 0; i < bubbles; ++i) {
    if (ring_[i] == elsewhere) continue;
    place_[i] = static_cast<std::int32_t>(rows_.size());
    rows_.push_back(static_cast<std::int32_t>(i)), fixed_.push_back(ring_[i] != corrected);
  }
}

void VolumePatch::correct(const FoamParams& params, const FoamTopology& topology,
                          const Neighbours& neighbours, BubbleStore& bubbles) {
  part_.gather(bubbles, rows_);
  takePart(topology, neighbours, rows_, place_, topology_);
  neighbours_.build(rows_.size(), topology_.overlaps);
  projectVolumes(params, topology_, neighbours_, fixed_, part_);
  changed_.clear();
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    const std::int32_t i = rows_[k];
    if (part_.radius[k] != bubbles.radius[i]) changed_.push_back(i);
    bubbles.radius[i] = part_.radius[k], bubbles.clamped[i] = part_.clamped[k];
  }
}

}  // namespace spume::foam
