#include "foam/forces/solid_attraction.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "foam/forces/weak_attraction.h"

namespace spume::foam {
namespace {

constexpr double kBetaRadius = 1.5e-3;  // [m] radius beta is given for
// A meniscus steeper than this is no longer thin against its width, and the cotangent law ends.
constexpr double kSteepest = 20;  // [degrees]

}  // namespace

double solidAttraction(const FoamParams& params, const SolidSurface& solid, double gas, double radius,
                       double psi) {
  const double length = capillaryLength(params);
  if (!(psi < kAttractionRange * length) || params.attractionLaw == AttractionLaw::none) return 0;
  if (params.attractionLaw == AttractionLaw::capillary) {
    const double angle = std::clamp(solid.contactAngle, kSteepest, 180 - kSteepest);
    return surfaceLoad(params, gas, radius) / std::tan(angle * std::numbers::pi / 180) *
           std::exp(-std::max(psi, 0.0) / length);
  }
  return solid.attraction * std::min(1.0, std::pow(radius / kBetaRadius, 3)) / std::max(psi, radius);
}

}  // namespace spume::foam
