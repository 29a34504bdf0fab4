#pragma once

#include <algorithm>
#include <cmath>

namespace spume::fluid {

/// Volume of {m . x < alpha} in the unit cube for 0 <= m1 <= m2 <= m3 summing to 1 and 0 <= alpha <= 1/2
/// [Scardovelli, Zaleski 2000, Eq. 15].
inline double cutVolume(double m1, double m2, double m3, double alpha) {
  const double m12 = m1 + m2;
  const double corner = 6 * m1 * m2 * m3;
  if (alpha < m1) return alpha * alpha * alpha / corner;
  if (alpha < m2) return (3 * alpha * (alpha - m1) + m1 * m1) / (6 * m2 * m3);
  if (alpha >= std::min(m12, m3) && m3 >= m12) return (alpha - 0.5 * m12) / m3;
  const double pair = m1 * m1 * (m1 - 3 * alpha) + m2 * m2 * (m2 - 3 * alpha);
  if (alpha < std::min(m12, m3)) return (alpha * alpha * (3 * m12 - alpha) + pair) / corner;
  return (alpha * alpha * (3 - 2 * alpha) + pair + m3 * m3 * (m3 - 3 * alpha)) / corner;
}

/// Part of the unit cube centred on 0 where value + gx x + gy y + gz z < 0, exactly. Without a slope: by the
/// sign of the value.
inline double planeFraction(double value, double gx, double gy, double gz) {
  const double sum = std::abs(gx) + std::abs(gy) + std::abs(gz);
  if (std::abs(value) >= 0.5 * sum) return value < 0 ? 1 : 0;
  const double scale = 1 / sum;
  const double a = scale * std::abs(gx), b = scale * std::abs(gy), c = scale * std::abs(gz);
  const double low = std::min(a, b), high = std::max(a, b);  // sorted without a branch to mispredict
  const double volume = cutVolume(std::min(low, c), std::max(low, std::min(high, c)), std::max(high, c),
                                  0.5 - scale * std::abs(value));
  return value >= 0 ? volume : 1 - volume;
}

}  // namespace spume::fluid
