#include "foam/forces/weak_attraction.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace spume::foam {
namespace {

constexpr double kAlphaRadius = 1e-3;  // [m] radius from which on alpha holds in full
constexpr double kLoadShare = 0.4;     // a film cannot carry more than this share of pi sigma r

template <std::size_t N>
double polynomial(const std::array<double, N>& coefficients, double x) {
  double sum = 0;
  for (std::size_t k = N; k-- > 0;) sum = sum * x + coefficients[k];
  return sum;
}

/// I1(x) / x for |x| <= 3.75.
double besselI1OverX(double x) {
  const double t = x / 3.75;
  return polynomial<7>({0.5, 0.87890594, 0.51498869, 0.15084934, 0.02658733, 0.00301532, 0.00032411}, t * t);
}

}  // namespace

double capillaryLength(const FoamParams& params) {
  const double g = params.gravity.norm();
  return g > 0 ? std::sqrt(params.surfaceTension / (params.density * g))
               : std::numeric_limits<double>::infinity();
}

double surfaceLoad(const FoamParams& params, double gas, double radius) {
  const double buoyancy = params.density * params.gravity.norm() * gas;
  return std::min(buoyancy, kLoadShare * std::numbers::pi * params.surfaceTension * radius);
}

double besselK1(double x) {
  if (x <= 2) {
    const double t = 0.25 * x * x;
    const double series =
        polynomial<7>({1, 0.15443144, -0.67278579, -0.18156897, -0.01919402, -0.00110404, -0.00004686}, t);
    return std::log(0.5 * x) * x * besselI1OverX(x) + series / x;
  }
  const double series = polynomial<7>(
      {1.25331414, 0.23498619, -0.03655620, 0.01504268, -0.00780353, 0.00325614, -0.00068245}, 2 / x);
  return series * std::exp(-x) / std::sqrt(x);
}

double weakAttraction(const FoamParams& params, double gasI, double radiusI, double gasJ, double radiusJ,
                      double distance) {
  const double length = capillaryLength(params);
  if (distance <= 0 || !(distance < kAttractionRange * length) || params.attractionLaw == AttractionLaw::none)
    return 0;
  if (params.attractionLaw == AttractionLaw::capillary) {
    const double loads = surfaceLoad(params, gasI, radiusI) * surfaceLoad(params, gasJ, radiusJ);
    return loads * besselK1(distance / length) / (2 * std::numbers::pi * params.surfaceTension * length);
  }
  const double radius = std::sqrt(radiusI * radiusJ);
  return params.attraction * std::min(1.0, std::pow(radius / kAlphaRadius, 3)) * radius / distance;
}

}  // namespace spume::foam
