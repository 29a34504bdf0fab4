#include "foam/volume_patch.h"

#include <functional>

#include "foam/parallel.h"
#include "foam/volume_correction.h"

namespace spume::foam {
namespace {

/// Newton steps at most: a cell covered all but wholly grows by a quarter in each.
constexpr int kSteps = 16;
/// Growth of a ball that is looked after. What less cuts off a ball of its own size that it has not touched
/// before, a cap as high as the growth, is below 1e-3 of that one's volume; off a much smaller one it may be
/// more, and the next step's measurement finds it.
constexpr double kGrown = 0.02;

}  // namespace

bool VolumePatch::settle(const FoamParams& params, const std::vector<NearWalls>& walls,
                         FoamTopology& topology, Neighbours& neighbours, BubbleStore& bubbles) {
  radius_ = bubbles.radius;
  for (int step = 0; step < kSteps; ++step) {
    const std::vector<std::int32_t> off = cellsOff(bubbles, params.volumeTolerance);
    if (off.empty()) break;
    if (step > 0) neighbours.build(bubbles.size(), topology.overlaps);
    choose(off, neighbours, bubbles.size());
    gather(walls, bubbles);
    correct(params, topology, neighbours);
    giveBack(topology, bubbles);
  }
  return hasAllPairs(topology.overlaps, bubbles);
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
  for (const Ring ring : {corrected, watched, cutting}) take(inner, ring), inner.swap(outer);
  rows_.clear(), fixed_.clear(), whole_.clear();
  for (std::size_t i = 0; i < bubbles; ++i) {
    if (ring_[i] == elsewhere) continue;
    place_[i] = static_cast<std::int32_t>(rows_.size());
    rows_.push_back(static_cast<std::int32_t>(i));
    fixed_.push_back(ring_[i] != corrected), whole_.push_back(ring_[i] != cutting);
  }
}

void VolumePatch::gather(const std::vector<NearWalls>& walls, const BubbleStore& bubbles) {
  part_.gather(bubbles, rows_);
  walls_.clear();
  if (walls.empty()) return;
  for (const std::int32_t i : rows_) walls_.push_back(walls[i]);
}

/// Leaves the patch as measured with its new radii.
void VolumePatch::correct(const FoamParams& params, const FoamTopology& topology,
                          const Neighbours& neighbours) {
  takePart(topology, neighbours, rows_, place_, topology_);
  neighbours_.build(rows_.size(), topology_.overlaps);
  projectVolumes(params, topology_, neighbours_, fixed_, part_);
  cells_.compute(part_, walls_, topology_);
}

void VolumePatch::giveBack(FoamTopology& topology, BubbleStore& bubbles) {
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    bubbles.radius[rows_[k]] = part_.radius[k];
    bubbles.clamped[rows_[k]] = part_.clamped[k];
  }
  replacer_.putBack(topology_, rows_, whole_, topology);
  noteVolumes(topology, bubbles);
}

/// Whether every ball that has grown knows all others it overlaps: a patch sees those in it alone.
bool VolumePatch::hasAllPairs(const std::vector<OverlapPair>& pairs, const BubbleStore& bubbles) {
  known_.assign(bubbles.size(), 0);
  for (const OverlapPair& pair : pairs) ++known_[pair.i], ++known_[pair.j];
  for (std::size_t i = 0; i < bubbles.size(); ++i) {
    const double r = bubbles.radius[i];
    if (r <= (1 + kGrown) * radius_[i]) continue;
    const Eigen::Vector3d& at = bubbles.position[i];
    const auto overlaps = [&](std::size_t j) {
      const double reach = r + bubbles.radius[j];
      return (bubbles.position[j] - at).squaredNorm() < reach * reach ? 1 : 0;
    };
    const int found = reduceIndices(bubbles.size(), 0, overlaps, std::plus<>()) - 1;
    if (found > known_[i]) return false;
  }
  return true;
}

}  // namespace spume::foam
