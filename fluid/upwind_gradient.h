#pragma once

#include <algorithm>

namespace spume::fluid {

/// Voxels that a fifth-order one-sided difference reads to each side.
inline constexpr int kUpwindReach = 3;

/// Fifth-order WENO value of a derivative from five consecutive differences, upwind first [Jiang, Peng 2000].
inline float wenoSlope(float a, float b, float c, float d, float e) {
  constexpr float kEpsilon = 1e-6f;  // keeps weights finite; relative to the slope squared, which is about 1
  const auto square = [](float x) { return x * x; };
  const float s0 = 13.0f / 12 * square(a - 2 * b + c) + 0.25f * square(a - 4 * b + 3 * c);
  const float s1 = 13.0f / 12 * square(b - 2 * c + d) + 0.25f * square(b - d);
  const float s2 = 13.0f / 12 * square(c - 2 * d + e) + 0.25f * square(3 * c - 4 * d + e);
  const float w0 = 0.1f / square(kEpsilon + s0);
  const float w1 = 0.6f / square(kEpsilon + s1);
  const float w2 = 0.3f / square(kEpsilon + s2);
  return (w0 * (2 * a - 7 * b + 11 * c) + w1 * (-b + 5 * c + 2 * d) + w2 * (2 * c + 5 * d - e)) /
         (6 * (w0 + w1 + w2));
}

/// What one axis adds to the squared gradient in Godunov's flux: of the one-sided slopes the larger of those
/// that point away from the surface. `v`: seven values a voxel apart, the voxel's own in the middle.
inline float upwindSquare(const float (&v)[2 * kUpwindReach + 1]) {
  const float a = v[1] - v[0], b = v[2] - v[1], c = v[3] - v[2], d = v[4] - v[3], e = v[5] - v[4],
              f = v[6] - v[5];
  const float sign = v[3] > 0 ? 1.0f : -1.0f;
  const float below = std::max(sign * wenoSlope(a, b, c, d, e), 0.0f);
  const float above = std::min(sign * wenoSlope(f, e, d, c, b), 0.0f);
  return std::max(below * below, above * above);
}

}  // namespace spume::fluid
