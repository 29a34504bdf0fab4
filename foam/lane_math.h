#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace spume::foam {

/// Loops over geometry run in whole blocks of this many doubles (one AVX-512 register), padded with neutral
/// elements: every element then goes through the same instructions wherever it stands in its block.
inline constexpr std::size_t kLanes = 8;

inline constexpr std::size_t paddedToLanes(std::size_t count) {
  return (count + kLanes - 1) / kLanes * kLanes;
}

/// Angle of the point (x, y), y >= 0, in [0, pi]; 0 at the origin. Without branches, so that loops over it
/// vectorise; within 2 ulp. Reduces to |z| <= tan(pi/8), where z P(z^2) with P the Chebyshev interpolant of
/// degree 11 of atan(z)/z is exact to 1.3e-18.
inline double upperAngle(double y, double x) {
  constexpr double kTanEighth = 0.41421356237309503, kTiny = 1e-300;
  const double ax = std::abs(x);
  const double small = y <= ax ? y : ax, large = y <= ax ? ax : y;
  const bool reduce = small > kTanEighth * large;
  const double top = reduce ? small - large : small, bottom = (reduce ? small + large : large) + kTiny;
  const double z = top / bottom, u = z * z;
  double p = -0.017805395704537507381;
  p = p * u + 0.037965256099576568431;
  p = p * u - 0.050351024039430294125;
  p = p * u + 0.058468782857870010961;
  p = p * u - 0.066629518120618369597;
  p = p * u + 0.076920453307659118451;
  p = p * u - 0.090908968090564377814;
  p = p * u + 0.11111110744919395758;
  p = p * u - 0.14285714279250239667;
  p = p * u + 0.19999999999940891408;
  p = p * u - 0.33333333333333121163;
  p = p * u + 1;
  double angle = z * p + (reduce ? std::numbers::pi / 4 : 0.0);
  angle = y <= ax ? angle : std::numbers::pi / 2 - angle;
  return x < 0 ? std::numbers::pi - angle : angle;
}

}  // namespace spume::foam
