#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace spume::apps {

inline constexpr float kWaterIndex = 1.33f;  ///< refractive index of water in visible light [-]
inline constexpr float kGlassIndex = 1.52f;  ///< of window glass [-]

/// Unpolarised reflectance of a plane between two dielectrics. `cosIn` = cosine of the angle of incidence,
/// 0..1; `eta` = index behind / index in front. Returns 1 under total internal reflection.
inline float fresnelReflectance(float cosIn, float eta) {
  const float sin2 = (1 - cosIn * cosIn) / (eta * eta);
  if (sin2 >= 1) return 1;
  const float cosOut = std::sqrt(1 - sin2);
  const float s = (cosIn - eta * cosOut) / (cosIn + eta * cosOut);
  const float p = (eta * cosIn - cosOut) / (eta * cosIn + cosOut);
  return 0.5f * (s * s + p * p);
}

/// Reflectance of a thin sheet of index `eta` with the same medium on both sides, all inner bounces summed.
inline float sheetReflectance(float cosIn, float eta) {
  const float once = fresnelReflectance(cosIn, eta);
  return 2 * once / (1 + once);
}

/// Mirror direction of `d` about the unit normal `n`.
inline Eigen::Vector3f reflect(const Eigen::Vector3f& d, const Eigen::Vector3f& n) {
  return d - 2 * d.dot(n) * n;
}

/// Refracted unit direction of `d` at the unit normal `n` that faces the incoming ray (d.n < 0); `eta` =
/// index behind / index in front. The caller has ruled out total internal reflection.
inline Eigen::Vector3f refract(const Eigen::Vector3f& d, const Eigen::Vector3f& n, float eta) {
  const float cosIn = -d.dot(n);
  const float cosOut = std::sqrt(std::max(0.0f, 1 - (1 - cosIn * cosIn) / (eta * eta)));
  return (d / eta + (cosIn / eta - cosOut) * n).normalized();
}

}  // namespace spume::apps
