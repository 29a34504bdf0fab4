#include "foam/forces/inertia.h"

namespace spume::foam {

double filmMass(const FoamParams& params, double gas, double wetness) {
  // A wet packing of spheres (lambda = 1) holds 36 % liquid, and the fraction falls with the square of
  // wetness.
  const double liquidFraction = 0.36 * wetness * wetness;
  return params.density * gas * liquidFraction / (1 - liquidFraction);
}

double weighedMass(const FoamParams& params, double gas, double wetness, double immersed) {
  return params.gasDensity * gas + filmMass(params, gas, wetness) * (1 - immersed);
}

double inertia(const FoamParams& params, double gas, double wetness, double immersed) {
  return weighedMass(params, gas, wetness, immersed) + params.addedMass * params.density * gas * immersed;
}

}  // namespace spume::foam
