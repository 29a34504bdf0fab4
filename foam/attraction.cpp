#include "foam/attraction.h"

#include <algorithm>
#include <cmath>

#include "foam/forces/solid_attraction.h"
#include "foam/forces/weak_attraction.h"

namespace spume::foam {

void Attraction::findPairs(const FoamParams& params, const BubbleStore& bubbles,
                           const FoamTopology& topology) {
  const double range = kAttractionRange * capillaryLength(params);
  pairs_.clear();
  if (params.weakPairs && std::isfinite(range))
    finder_.find(bubbles.position, bubbles.radius, bubbles.id, floats_, topology, range, pairs_);
}

void Attraction::compute(const FoamParams& params, const BubbleStore& bubbles, const Surroundings& around,
                         const FoamTopology& topology, Vectors3& force) {
  const std::size_t n = bubbles.size();
  force.assign(n, Eigen::Vector3d::Zero());
  floats_.resize(n);
  for (std::size_t i = 0; i < n; ++i)
    floats_[i] =
        std::abs(around.phi[i]) <= bubbles.radius[i] && bubbles.surfaceWeight[i] > 0 && !bubbles.hidden[i];
  const bool anyFloats = std::find(floats_.begin(), floats_.end(), 1) != floats_.end();
  if (params.attractionLaw == AttractionLaw::none || !anyFloats) return;
  findPairs(params, bubbles, topology);
  const std::vector<double>&gas = bubbles.gas, &radius = bubbles.radius, &weight = bubbles.surfaceWeight;
  for (const WeakPair& pair : pairs_) {
    const double pull =
        weight[pair.i] * weight[pair.j] *
        weakAttraction(params, gas[pair.i], radius[pair.i], gas[pair.j], radius[pair.j], pair.distance);
    const Eigen::Vector3d step = (bubbles.position[pair.j] - bubbles.position[pair.i]) / pair.distance;
    force[pair.i] += pull * step, force[pair.j] -= pull * step;
  }
  for (std::size_t i = 0; i < n; ++i) {
    if (!floats_[i] || around.psi[i] <= radius[i] || bubbles.touchedSolid[i]) continue;
    const SolidSurface& solid = params.surfaceOf(around.solid[i]);
    force[i] -=
        weight[i] * solidAttraction(params, solid, gas[i], radius[i], around.psi[i]) * around.gradPsi.col(i);
  }
}

}  // namespace spume::foam
