#include "foam/radius_distribution.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace spume::foam {
namespace {

/// A cut that leaves next to nothing of the distribution would be redrawn for ever.
constexpr int kMaxRedraws = 1000;

double drawPower(double exponent, double least, double most, double u) {
  const double n = exponent + 1;
  if (std::abs(n) < 1e-9) return least * std::pow(most / least, u);  // the limit of what follows
  const double low = std::pow(least, n), high = std::pow(most, n);
  return std::pow(low + u * (high - low), 1 / n);
}

}  // namespace

double drawNormal(CounterRandom& random) {
  const double radial = std::sqrt(-2 * std::log(1 - random.uniform()));
  return radial * std::cos(2 * std::numbers::pi * random.uniform());
}

double RadiusDistribution::draw(CounterRandom& random) const {
  if (law == RadiusLaw::uniform) return least + random.uniform() * (most - least);
  if (law == RadiusLaw::powerLaw)
    return std::clamp(drawPower(exponent, least, most, random.uniform()), least, most);
  for (int i = 0; i < kMaxRedraws; ++i) {
    const double radius = median * std::exp(sigma * drawNormal(random));
    if (radius >= least && radius <= most) return radius;
  }
  return std::clamp(median, least, most);
}

}  // namespace spume::foam
