#include "foam/forces/solid_adhesion.h"

#include <cmath>
#include <numbers>

namespace spume::foam {

double pinningForce(const FoamParams& params, const SolidSurface& solid) {
  return params.density * params.gravity.norm() * 4 * std::numbers::pi / 3 * std::pow(solid.detachRadius, 3);
}

bool adheres(const FoamParams& params, const SolidSurface& solid, double gas, double radius, double immersed,
             double psi) {
  const double buoyancy = immersed * params.density * params.gravity.norm() * gas;
  return solid.adhesion > 0 && solid.detachRadius > 0 && buoyancy <= pinningForce(params, solid) &&
         psi <= kLetGo * radius;
}

}  // namespace spume::foam
