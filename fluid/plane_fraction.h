#pragma once

#include <algorithm>
#include <cmath>

namespace spume::fluid {

/// Volume of {m . x < alpha} in the unit cube for 0 <= m1 <= m2 <= m3 summing to 1 and 0 <= alpha <= 1/2
/// [Scardovelli, Zaleski 2000, Eq. 15].
inline double cutVolume(double m1, double m2, double m3, double alpha) {
  const double m12 = m1 + m2;
  const double low = m1 * m1 / std::max(6 * m2 * m3, 1e-300);
  const double corner = 6 * m1 * m2 * m3;
  if (alpha < m1) return alpha * alpha * alpha / corner;
  if (alpha < m2) return alpha * (alpha - m1) / (2 * m2 * m3) + low;
  if (alpha >= std::min(m12, m3) && m3 >= m12) return (alpha - 0.5 * m12) / m3;
  const double pair = m1 * m1 * (m1 - 3 * alpha) + m2 * m2 * (m2 - 3 * alpha);
  if (alpha < std::min(m12, m3)) return (alpha * alpha * (3 * m12 - alpha) + pair) / corner;
  return (alpha * alpha * (3 - 2 * alpha) + pair + m3 * m3 * (m3 - 3 * alpha)) / corner;
}

/// Part of the unit cube centred on 0 where value + gx x + gy y + gz z < 0, exactly. Without a slope: by the
/// sign of the value.
inline double planeFraction(double value, double gx, double gy, double gz) {
  double a = std::abs(gx), b = std::abs(gy), c = std::abs(gz);
  const double sum = a + b + c;
  if (std::abs(value) >= 0.5 * sum) return value < 0 ? 1 : 0;
  if (a > b) std::swap(a, b);
  if (b > c) std::swap(b, c);
  if (a > b) std::swap(a, b);
  const double alpha = 0.5 - value / sum;
  const double volume = cutVolume(a / sum, b / sum, c / sum, std::min(alpha, 1 - alpha));
  return alpha <= 0.5 ? volume : 1 - volume;
}

}  // namespace spume::fluid
