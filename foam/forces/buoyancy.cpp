#include "foam/forces/buoyancy.h"

#include <algorithm>
#include <cmath>

namespace spume::foam {

double immersedFraction(double phi, double radius) {
  const double s = std::clamp(phi / radius, -1.0, 1.0);
  return 0.25 * (2 + s) * (1 - s) * (1 - s);
}

double immersedFractionSlope(double phi, double radius) {
  const double s = phi / radius;
  return std::abs(s) >= 1 ? 0 : -0.75 * (1 - s * s) / radius;
}

Eigen::Vector3d fullBuoyancy(const FoamParams& params, double gas, const Eigen::Vector3d& gradPressure) {
  if (params.buoyancyLaw == BuoyancyLaw::pressureGradient) return -gas * gradPressure;
  return -params.density * gas * params.gravity;
}

}  // namespace spume::foam
