#include "foam/volume_correction.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "foam/forces/buoyancy.h"
#include "foam/parallel.h"

namespace spume::foam {

double gasRadius(double gas) { return std::cbrt(3 * gas / (4 * std::numbers::pi)); }

double freeShare(double psi, double radius) { return immersedFraction(-psi, radius); }

void correctVolumes(const FoamParams& params, const FoamTopology& topology, const Eigen::VectorXd& psi,
                    double dt, BubbleStore& bubbles) {
  const double exponent = -std::expm1(-params.volumeRate * dt) / 3;
  forEachIndex(bubbles.size(), [&](std::size_t i) {
    const double r0 = gasRadius(bubbles.gas[i]),
                 ballVolume = bubbles.gas[i] * std::pow(bubbles.radius[i] / r0, 3);
    const bool hasCell = !topology.hidden[i] && topology.volume[i] > 0 && psi[i] > -bubbles.radius[i];
    bubbles.volume[i] = topology.volume[i] * freeShare(psi[i], bubbles.radius[i]);
    bubbles.hidden[i] = topology.hidden[i];
    const double ratio = bubbles.gas[i] / (hasCell ? bubbles.volume[i] : ballVolume);
    const double wanted = bubbles.radius[i] * std::pow(ratio, exponent);
    bubbles.clamped[i] = wanted > params.radiusLimit * r0;
    bubbles.radius[i] = std::min(wanted, params.radiusLimit * r0);
  });
}

}  // namespace spume::foam
