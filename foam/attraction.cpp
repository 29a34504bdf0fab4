#include "foam/attraction.h"

#include <algorithm>
#include <cmath>

#include "foam/forces/solid_attraction.h"
#include "foam/forces/weak_attraction.h"
#include "foam/parallel.h"

namespace spume::foam {
namespace {

/// Gradient of psi over the width of each listed bubble, by central differences: at a flat solid the normal,
/// shorter where walls meet, and continuous everywhere.
Eigen::Matrix3Xd slopesAcross(const LiquidSampler& liquid, const BubbleStore& bubbles,
                              const std::vector<std::size_t>& listed) {
  const auto n = static_cast<Eigen::Index>(listed.size());
  Eigen::Matrix3Xd slope = Eigen::Matrix3Xd::Zero(3, n), point(3, n);
  Eigen::VectorXd psi(n);
  if (n == 0) return slope;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      for (Eigen::Index k = 0; k < n; ++k) {
        const std::size_t i = listed[static_cast<std::size_t>(k)];
        point.col(k) = bubbles.position[i] + side * bubbles.radius[i] * Eigen::Vector3d::Unit(axis);
      }
      liquid.psi(point, psi);
      for (Eigen::Index k = 0; k < n; ++k)
        slope(axis, k) += side * psi[k] / (2 * bubbles.radius[listed[static_cast<std::size_t>(k)]]);
    }
  return slope;
}

}  // namespace

void Attraction::findPairs(const FoamParams& params, const BubbleStore& bubbles,
                           const FoamTopology& topology) {
  const double range = kAttractionRange * capillaryLength(params);
  pairs_.clear();
  if (params.weakPairs && std::isfinite(range))
    finder_.find(bubbles.position, bubbles.radius, bubbles.id, floats_, topology, range, pairs_);
}

void Attraction::addPairs(const FoamParams& params, const BubbleStore& bubbles, Vectors3& force) {
  const std::vector<double>&gas = bubbles.gas, &radius = bubbles.radius, &weight = bubbles.surfaceWeight;
  pull_.resize(pairs_.size());
  forEachIndex(pairs_.size(), [&](std::size_t k) {
    const WeakPair& pair = pairs_[k];
    const double pull =
        weight[pair.i] * weight[pair.j] *
        weakAttraction(params, gas[pair.i], radius[pair.i], gas[pair.j], radius[pair.j], pair.distance);
    pull_[k] = pull * ((bubbles.position[pair.j] - bubbles.position[pair.i]) / pair.distance);
  });
  for (std::size_t k = 0; k < pairs_.size(); ++k)  // in the order of the pairs, whoever has found the pulls
    force[pairs_[k].i] += pull_[k], force[pairs_[k].j] -= pull_[k];
}

void Attraction::addSolids(const FoamParams& params, const BubbleStore& bubbles, const Surroundings& around,
                           const LiquidSampler& liquid, Vectors3& force) const {
  const double range = kAttractionRange * capillaryLength(params);
  std::vector<std::size_t> drawn;
  for (std::size_t i = 0; i < bubbles.size(); ++i)
    if (floats_[i] && around.psi[i] < range && !bubbles.touchedSolid[i]) drawn.push_back(i);
  const Eigen::Matrix3Xd slope = slopesAcross(liquid, bubbles, drawn);
  for (std::size_t k = 0; k < drawn.size(); ++k) {
    const std::size_t i = drawn[k];
    const SolidSurface& solid = params.surfaceOf(around.solid[i]);
    const double pull = solidAttraction(params, solid, bubbles.gas[i], bubbles.radius[i], around.psi[i]);
    force[i] -= bubbles.surfaceWeight[i] * pull * slope.col(static_cast<Eigen::Index>(k));
  }
}

void Attraction::compute(const FoamParams& params, const BubbleStore& bubbles, const Surroundings& around,
                         const LiquidSampler& liquid, const FoamTopology& topology, Vectors3& force) {
  const std::size_t n = bubbles.size();
  force.assign(n, Eigen::Vector3d::Zero());
  floats_.resize(n);
  for (std::size_t i = 0; i < n; ++i)
    floats_[i] =
        std::abs(around.phi[i]) <= bubbles.radius[i] && bubbles.surfaceWeight[i] > 0 && !bubbles.hidden[i];
  const bool anyFloats = std::find(floats_.begin(), floats_.end(), 1) != floats_.end();
  if (params.attractionLaw == AttractionLaw::none || !anyFloats) return;
  findPairs(params, bubbles, topology);
  addPairs(params, bubbles, force);
  addSolids(params, bubbles, around, liquid, force);
}

}  // namespace spume::foam
