#include "foam/volume_patch.h"

#include <algorithm>
#include <cmath>

#include "foam/volume_correction.h"
#include "foam/volume_newton.h"

namespace spume::foam {
namespace {

/// Newton steps at most: a cell covered all but wholly grows by a quarter in each.
constexpr int kSteps = 16;
/// Times in a step that neighbours join in; two or three are enough as a rule.
constexpr int kPasses = 8;
/// Share of the tolerance up to which a neighbour may be disturbed and stay as it is: the rest is for what is
/// not linear.
constexpr double kSpare = 0.9;

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
  for (const std::int32_t i : off) ring_[i] = isOff;
  take(off, beside);
  inner.insert(inner.end(), outer.begin(), outer.end());
  take(inner, watched);
  rows_.clear(), fixed_.clear();
  for (std::size_t i = 0; i < bubbles; ++i) {
    if (ring_[i] == elsewhere) continue;
    place_[i] = static_cast<std::int32_t>(rows_.size());
    rows_.push_back(static_cast<std::int32_t>(i)), fixed_.push_back(ring_[i] != isOff);
  }
}

void VolumePatch::correct(const FoamParams& params, const FoamTopology& topology,
                          const Neighbours& neighbours, BubbleStore& bubbles) {
  gather(bubbles);
  takePart(topology, neighbours, rows_, place_, topology_);
  neighbours_.build(rows_.size(), topology_.overlaps);
  project(params);
  changed_.clear();
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    const std::int32_t i = rows_[k];
    if (part_.radius[k] != bubbles.radius[i]) changed_.push_back(i);
    bubbles.radius[i] = part_.radius[k], bubbles.clamped[i] = part_.clamped[k];
  }
}

void VolumePatch::gather(const BubbleStore& bubbles) {
  part_.id.clear(), part_.gas.clear(), part_.radius.clear(), part_.clamped.clear();
  for (const std::int32_t i : rows_) {
    part_.id.push_back(bubbles.id[i]), part_.gas.push_back(bubbles.gas[i]);
    part_.radius.push_back(bubbles.radius[i]), part_.clamped.push_back(bubbles.clamped[i]);
  }
}

/// Corrects those off, again with the neighbours that this disturbs until no more join in: most need not, and
/// of what stays as it is nobody has to measure the surroundings.
void VolumePatch::project(const FoamParams& params) {
  radius_ = part_.radius;
  const std::vector<std::uint8_t> clamped = part_.clamped;
  for (int pass = 0; pass < kPasses; ++pass) {
    part_.radius = radius_, part_.clamped = clamped;
    projectVolumes(params, topology_, neighbours_, fixed_, part_);
    if (!freeDisturbed(params)) return;
  }
}

/// Lets those neighbours of cells off change that the last projection would put off as well, if they stayed;
/// false if there is none.
bool VolumePatch::freeDisturbed(const FoamParams& params) {
  change_.resize(rows_.size());
  for (std::size_t k = 0; k < rows_.size(); ++k)
    change_[k] = part_.radius[k] * part_.radius[k] - radius_[k] * radius_[k];
  bool isAny = false;
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    if (!fixed_[k] || ring_[rows_[k]] != beside || topology_.hidden[k]) continue;
    const double gas = part_.gas[k];
    const double missing = gas - topology_.volume[k] + volumeLost(topology_, neighbours_, change_, k);
    const bool isShort = part_.clamped[k] && missing > 0;  // and cannot grow
    if (isShort || std::abs(missing) <= kSpare * params.volumeTolerance * gas) continue;
    fixed_[k] = 0, isAny = true;
  }
  return isAny;
}

}  // namespace spume::foam
