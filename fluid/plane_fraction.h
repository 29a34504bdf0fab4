#pragma once

#include <algorithm>
#include <cmath>

namespace spume::fluid {

/// Volume of {m . x < alpha} in the unit cube for 0 <= m1 <= m2 <= m3 summing to 1 and 0 <= alpha <= 1/2
/// [Scardovelli, Zaleski 2000, Eq. 15]. All forms are computed and one is chosen, so that a loop over planes
/// vectorises; the others may be infinite or no number.
inline double cutVolume(double m1, double m2, double m3, double alpha) {
  const double m12 = m1 + m2, square = alpha * alpha;
  const double perCorner = 1 / (6 * m1 * m2 * m3);
  const double corner = square * alpha * perCorner;
  const double wedge = (3 * alpha * (alpha - m1) + m1 * m1) / (6 * m2 * m3);
  const double slab = (alpha - 0.5 * m12) / m3;
  const double pair = m1 * m1 * (m1 - 3 * alpha) + m2 * m2 * (m2 - 3 * alpha);
  const double twice = (square * (3 * m12 - alpha) + pair) * perCorner;
  const double thrice = (square * (3 - 2 * alpha) + pair + m3 * m3 * (m3 - 3 * alpha)) * perCorner;
  const bool beyondTwo = alpha >= m12, beyondThree = alpha >= m3;
  const double three = beyondTwo | beyondThree ? thrice : twice;
  const double four = (m3 >= m12) & beyondTwo ? slab : three;
  const double two = alpha < m2 ? wedge : four;
  return alpha < m1 ? corner : two;
}

/// Part of the unit cube centred on 0 where value + gx x + gy y + gz z < 0, exactly. Without a slope: by the
/// sign of the value. Without branches: a loop over it vectorises.
inline double planeFraction(double value, double gx, double gy, double gz) {
  const double size = std::abs(value);
  const double sum = std::abs(gx) + std::abs(gy) + std::abs(gz), scale = 1 / sum;
  const double a = scale * std::abs(gx), b = scale * std::abs(gy), c = scale * std::abs(gz);
  const double low = std::min(a, b), high = std::max(a, b);
  const double volume =
      cutVolume(std::min(low, c), std::max(low, std::min(high, c)), std::max(high, c), 0.5 - scale * size);
  const double part = value >= 0 ? volume : 1 - volume, uncut = value < 0 ? 1 : 0;
  return size >= 0.5 * sum ? uncut : part;
}

}  // namespace spume::fluid
