#include "foam/volume_patch.h"

#include "foam/volume_correction.h"

namespace spume::foam {
namespace {

/// Newton steps at most: a cell covered all but wholly grows by a quarter in each.
constexpr int kPasses = 10;

}  // namespace

void VolumePatch::choose(const std::vector<std::int32_t>& off, const Neighbours& neighbours,
                         std::size_t bubbles) {
  ring_.assign(bubbles, 0);
  const auto around = [&](std::int32_t i, char ring) {
    for (std::int32_t e = neighbours.start[i]; e < neighbours.start[i + 1]; ++e)
      if (ring_[neighbours.other[e]] == 0) ring_[neighbours.other[e]] = ring;
  };
  for (const std::int32_t i : off) ring_[i] = 1;
  for (const std::int32_t i : off) around(i, 1);
  for (std::size_t i = 0; i < bubbles; ++i)
    if (ring_[i] == 1) around(static_cast<std::int32_t>(i), 2);
  rows_.clear(), fixed_.clear();
  for (std::size_t i = 0; i < bubbles; ++i) {
    if (ring_[i] == 0) continue;
    rows_.push_back(static_cast<std::int32_t>(i)), fixed_.push_back(ring_[i] == 2);
  }
}

void VolumePatch::settle(const FoamParams& params, const std::vector<std::int32_t>& off,
                         const Neighbours& neighbours, const std::vector<NearWalls>& walls,
                         BubbleStore& bubbles) {
  choose(off, neighbours, bubbles.size());
  part_.gather(bubbles, rows_);
  walls_.clear();
  if (!walls.empty())
    for (const std::int32_t i : rows_) walls_.push_back(walls[i]);
  for (int pass = 0; pass < kPasses; ++pass) {
    cells_.compute(part_, walls_, topology_);
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      // A fixed cell is cut by bubbles that are not here.
      part_.volume[k] = fixed_[k] ? part_.gas[k] : topology_.volume[k];
      part_.hidden[k] = topology_.hidden[k];
    }
    if (cellsOff(part_, params.volumeTolerance).empty()) break;
    projectVolumes(params, topology_, fixed_, part_);
  }
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    bubbles.radius[rows_[k]] = part_.radius[k];
    bubbles.clamped[rows_[k]] = part_.clamped[k];
  }
}

}  // namespace spume::foam
