#include "foam/forces/strong_spring.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace spume::foam {
namespace {

/// Share of the rest film at which a stretched contact has its full pull (model, "strong spring").
constexpr double kFullFilmShare = 0.1;

double stretchedShare(double ri, double rj, double rest, double filmArea) {
  const double restArea = filmDiscArea(ri, rj, rest);
  return restArea > 0 ? std::min(1.0, filmArea / (kFullFilmShare * restArea)) : 0;
}

}  // namespace

double wetnessAt(const FoamParams& params, double phi, double own) {
  if (params.wetnessLaw == WetnessLaw::constant) return params.wetness;
  if (params.wetnessLaw == WetnessLaw::perBubble) return own < 0 ? params.wetness : own;
  const double share = std::clamp(phi / params.wetnessHeight, 0.0, 1.0);
  return (1 - share) * params.wetness + share * params.wetnessAloft;
}

double restLength(double ri, double rj, double wetness) {
  return std::sqrt(ri * ri + rj * rj + (3 * wetness - 1) * ri * rj);
}

double filmDiscArea(double ri, double rj, double distance) {
  if (distance <= 0) return 0;
  const double height = (distance * distance + ri * ri - rj * rj) / (2 * distance);
  return std::max(0.0, std::numbers::pi * (ri * ri - height * height));
}

double springStiffness(const FoamParams& params, double ri, double rj) {
  const double base = params.springFromSurfaceTension
                          ? 2 * std::numbers::pi * params.surfaceTension * params.springSurfaceTensionFactor
                          : params.springStiffness;
  return std::max(base, params.springFloor * params.density * params.gravity.norm() * ri * rj);
}

PairSpring strongSpring(double stiffness, double ri, double rj, double wetness, double distance,
                        double filmArea) {
  const double rest = restLength(ri, rj, wetness);
  // The geometric stiffness of a compressed spring is negative and left out [Choi and Ko 2002].
  if (distance < rest) return {stiffness * (distance - rest), stiffness, 0};
  const double pull = stiffness * stretchedShare(ri, rj, rest, filmArea);
  return {pull * (distance - rest), pull, pull * (1 - rest / distance)};
}

}  // namespace spume::foam
