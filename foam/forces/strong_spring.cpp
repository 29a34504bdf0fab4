#include "foam/forces/strong_spring.h"

namespace spume::foam {

double wetnessAt(const FoamParams& params, double phi, double own) {
  if (params.wetnessLaw == WetnessLaw::constant) return params.wetness;
  if (params.wetnessLaw == WetnessLaw::perBubble) return own < 0 ? params.wetness : own;
  const double share = std::clamp(phi / params.wetnessHeight, 0.0, 1.0);
  return (1 - share) * params.wetness + share * params.wetnessAloft;
}

SpringLaw::SpringLaw(const FoamParams& params)
    : constant(params.springFromSurfaceTension
                   ? 2 * std::numbers::pi * params.surfaceTension * params.springSurfaceTensionFactor
                   : params.springStiffness),
      floor(params.springFloor * params.density * params.gravity.norm()) {}

double springStiffness(const FoamParams& params, double ri, double rj) { return SpringLaw(params)(ri, rj); }

}  // namespace spume::foam
