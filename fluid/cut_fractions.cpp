#include "fluid/cut_fractions.h"

#include <algorithm>
#include <functional>

namespace spume::fluid {
namespace {

/// Fraction of the edge from a positive end `a` to a negative end `b` that is positive.
double positivePart(double a, double b) { return a / (a - b); }

double tetrahedronFraction(std::array<double, 4> v) {
  std::sort(v.begin(), v.end(), std::greater<>());
  const auto positive = std::count_if(v.begin(), v.end(), [](double x) { return x > 0; });
  const auto corner = [&](int tip, int a, int b, int c) {  // share of the corner at `tip`, of the other sign
    return positivePart(v[tip], v[a]) * positivePart(v[tip], v[b]) * positivePart(v[tip], v[c]);
  };
  if (positive == 0) return 0;
  if (positive == 1) return corner(0, 1, 2, 3);
  if (positive == 3) return 1 - corner(3, 0, 1, 2);
  if (positive == 4) return 1;
  const double ac = positivePart(v[0], v[2]), ad = positivePart(v[0], v[3]);
  const double bc = positivePart(v[1], v[2]), bd = positivePart(v[1], v[3]);
  return bc * bd + ac * ad * (1 - bd) + ac * bd * (1 - bc);  // a wedge as three tetrahedra
}

}  // namespace

double squareFraction(const std::array<double, 4>& corner) {
  const auto positive = std::count_if(corner.begin(), corner.end(), [](double x) { return x > 0; });
  if (positive == 0) return 0;
  if (positive == 4) return 1;
  const auto cutCorner = [&](int tip) {  // triangle at a corner whose neighbours have the other sign
    return 0.5 * positivePart(corner[tip], corner[(tip + 1) % 4]) *
           positivePart(corner[tip], corner[(tip + 3) % 4]);
  };
  const auto isPositive = [&](int n) { return corner[n % 4] > 0; };
  if (positive != 2) {
    const bool one = positive == 1;
    int odd = 0;
    while (isPositive(odd) != one) ++odd;
    return one ? cutCorner(odd) : 1 - cutCorner(odd);
  }
  if (isPositive(0) == isPositive(2)) {  // saddle
    const bool joined = corner[0] + corner[1] + corner[2] + corner[3] > 0;
    const int tip = isPositive(0) != joined ? 0 : 1;
    const double corners = cutCorner(tip) + cutCorner(tip + 2);
    return joined ? 1 - corners : corners;
  }
  int first = 0;  // the positive pair is (first, first + 1)
  while (!(isPositive(first) && isPositive(first + 1))) ++first;
  return 0.5 * (positivePart(corner[first], corner[(first + 3) % 4]) +
                positivePart(corner[(first + 1) % 4], corner[(first + 2) % 4]));
}

double cubeFraction(const std::array<double, 8>& corner) {
  const auto [low, high] = std::minmax_element(corner.begin(), corner.end());
  if (*low > 0) return 1;
  if (*high <= 0) return 0;
  constexpr int kPath[6][2] = {{1, 3}, {3, 2}, {2, 6}, {6, 4}, {4, 5}, {5, 1}};  // around the diagonal 0-7
  double sum = 0;
  for (const auto& path : kPath)
    sum += tetrahedronFraction({corner[0], corner[path[0]], corner[path[1]], corner[7]});
  return sum / 6;
}

}  // namespace spume::fluid
