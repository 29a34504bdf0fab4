#pragma once

#include <array>
#include <cstddef>

namespace spume::fluid {

/// Weights of the values at -1, 0, 1, 2 in the cubic through them, at t in [0, 1].
inline std::array<float, 4> cubicWeights(float t) {
  const float u = 1 - t;
  return {-t * u * (1 + u) / 6, (1 + t) * u * (1 + u) / 2, t * (1 + t) * (1 + u) / 2, -t * u * (1 + t) / 6};
}

/// Weights of the same values in the derivative of that cubic.
inline std::array<float, 4> cubicSlopeWeights(float t) {
  const float tt = t * t;
  return {(-3 * tt + 6 * t - 2) / 6, (3 * tt - 4 * t - 1) / 2, (-3 * tt + 2 * t + 2) / 2, (3 * tt - 1) / 6};
}

/// Value and gradient per cell of the tricubic through the 4^3 values around the cube whose low corner is p.
struct CubicValue {
  float value, gx, gy, gz;
};
inline CubicValue cubicValue(const float* p, std::ptrdiff_t si, std::ptrdiff_t sj, float tx, float ty,
                             float tz) {
  const auto wx = cubicWeights(tx), wy = cubicWeights(ty), wz = cubicWeights(tz);
  const auto dx = cubicSlopeWeights(tx), dy = cubicSlopeWeights(ty), dz = cubicSlopeWeights(tz);
  CubicValue sum{};
  for (int i = 0; i < 4; ++i) {
    float value = 0, gy = 0, gz = 0;
    for (int j = 0; j < 4; ++j) {
      const float* row = p + (i - 1) * si + (j - 1) * sj - 1;
      const float onRow = wz[0] * row[0] + wz[1] * row[1] + wz[2] * row[2] + wz[3] * row[3];
      value += wy[j] * onRow;
      gy += dy[j] * onRow;
      gz += wy[j] * (dz[0] * row[0] + dz[1] * row[1] + dz[2] * row[2] + dz[3] * row[3]);
    }
    sum.value += wx[i] * value;
    sum.gx += dx[i] * value;
    sum.gy += wx[i] * gy;
    sum.gz += wx[i] * gz;
  }
  return sum;
}

/// The same for the trilinear interpolant of the eight values of that cube.
inline CubicValue linearValue(const float* p, std::ptrdiff_t si, std::ptrdiff_t sj, float tx, float ty,
                              float tz) {
  const auto mix = [](float a, float b, float t) { return a + t * (b - a); };
  const float c00 = mix(p[0], p[1], tz), c01 = mix(p[sj], p[sj + 1], tz);
  const float c10 = mix(p[si], p[si + 1], tz), c11 = mix(p[si + sj], p[si + sj + 1], tz);
  const float c0 = mix(c00, c01, ty), c1 = mix(c10, c11, ty);
  const float d0 = mix(p[1] - p[0], p[sj + 1] - p[sj], ty);
  const float d1 = mix(p[si + 1] - p[si], p[si + sj + 1] - p[si + sj], ty);
  return {mix(c0, c1, tx), c1 - c0, mix(c01 - c00, c11 - c10, tx), mix(d0, d1, tx)};
}

}  // namespace spume::fluid
