#include "foam/forces/air_drag.h"

#include <numbers>

namespace spume::foam {

double airDragFactor(const FoamParams& params, double radius) {
  if (params.airDragLaw == AirDragLaw::coefficient) return params.airDragCoefficient;
  return 6 * std::numbers::pi * params.gasViscosity * radius;
}

}  // namespace spume::foam
