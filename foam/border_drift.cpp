#include "foam/border_drift.h"

#include <algorithm>
#include <cmath>

#include "foam/forces/buoyancy.h"
#include "foam/forces/strong_spring.h"
#include "foam/parallel.h"
#include "foam/volume_correction.h"
#include "foam/wall_cells.h"

namespace spume::foam {
namespace {

/// Largest share of f / (2 sigma) in a step, whatever the rate: froths descend to least area at 0.15, and
/// overshoot beyond.
constexpr double kLargestShare = 0.1;
/// Longest move in a step, in radii of the gas: a border about to vanish pulls as hard as any, and within a
/// step it shall not pass through more than that.
constexpr double kLongestMove = 0.02;

}  // namespace

void BorderDrift::find(const FoamParams& params, const Surroundings& around, const FoamTopology& topology,
                       const Neighbours& neighbours, const std::vector<NearWalls>& walls,
                       const BubbleStore& bubbles, double dt) {
  move_.clear();
  if (params.borderRate == 0) return;
  const std::size_t n = bubbles.size();
  tension_.resize(n), wetness_.resize(n), fixed_.resize(n);
  forEachIndex(n, [&](std::size_t i) {
    const double phi = around.phi[static_cast<Eigen::Index>(i)];
    wetness_[i] = wetnessAt(params, phi, bubbles.wetness[i]);
    tension_[i] = (1 - wetness_[i]) * (1 - immersedFraction(phi, bubbles.radius[i]));
    fixed_[i] = tension_[i] == 0 || bubbles.clamped[i] || topology.hidden[i];
  });
  films_.compute(bubbles, topology, neighbours, walls, tension_, wetness_, fixed_);
  const double share = std::min(kLargestShare, -std::expm1(-params.borderRate * dt));
  move_.resize(n);
  forEachIndex(n, [&](std::size_t i) { move_[i] = move(i, share, walls, bubbles); });
}

/// A bubble at a solid slides along it: a wall's own spring sets its distance.
Eigen::Vector3d BorderDrift::move(std::size_t i, double share, const std::vector<NearWalls>& walls,
                                  const BubbleStore& bubbles) const {
  if (fixed_[i]) return Eigen::Vector3d::Zero();
  Eigen::Vector3d move = share * films_.force()[i];
  for (int w = 0; !walls.empty() && w < walls[i].count; ++w) {
    if (walls[i].wall[w].psi >= kCutByWall * bubbles.radius[i]) continue;
    const Eigen::Vector3d away = walls[i].wall[w].away.normalized();
    move -= away.dot(move) * away;
  }
  const double longest = kLongestMove * gasRadius(bubbles.gas[i]), length = move.norm();
  return length > longest ? Eigen::Vector3d(longest / length * move) : move;
}

void BorderDrift::advance(BubbleStore& bubbles) const {
  if (move_.empty()) return;
  forEachIndex(bubbles.size(), [&](std::size_t i) { bubbles.position[i] += move_[i]; });
}

}  // namespace spume::foam
