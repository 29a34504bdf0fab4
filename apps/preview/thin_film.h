#pragma once

#include <cmath>

#include "apps/preview/fresnel.h"

namespace spume::apps {

/// Wavelengths the eye's red, green and blue are centred at, and the width of each band (standard deviation),
/// which makes the colours of thick films fade [m].
inline constexpr float kBandCentre[3] = {610e-9f, 545e-9f, 460e-9f};
inline constexpr float kBandWidth = 28e-9f;

/// Phase between light mirrored at the two faces of a film of water in air, without the half wave the first
/// face adds [rad]: 4 pi n t cos(inside) / wavelength.
inline float filmPhase(float cosIn, float thickness, float wavelength) {
  const float cosInside = std::sqrt(1 - (1 - cosIn * cosIn) / (kWaterIndex * kWaterIndex));
  return 4 * static_cast<float>(M_PI) * kWaterIndex * thickness * cosInside / wavelength;
}

/// Reflectance of a film of water of `thickness` [m] in air for red, green and blue [Born & Wolf, Sec. 7.6]:
/// the Airy sum F/(1 + F) with F = 4 R sin^2(phase/2)/(1 - R)^2, sin^2 averaged over a Gaussian band. A film
/// much thinner than light is black; a thick one has no colour, because sin^2 averages to 1/2.
inline Eigen::Vector3f filmReflectance(float cosIn, float thickness) {
  const float once = fresnelReflectance(cosIn, kWaterIndex);
  Eigen::Vector3f share;
  for (int c = 0; c < 3; ++c) {
    const float phase = filmPhase(cosIn, thickness, kBandCentre[c]);
    const float spread = phase * kBandWidth / kBandCentre[c];
    const float sine2 = 0.5f * (1 - std::exp(-0.5f * spread * spread) * std::cos(phase));
    const float finesse = 4 * once * sine2 / std::max((1 - once) * (1 - once), 1e-6f);
    share[c] = finesse / (1 + finesse);
  }
  return share;
}

}  // namespace spume::apps
