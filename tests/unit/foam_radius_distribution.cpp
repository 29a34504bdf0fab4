// Radii of new bubbles.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "foam/radius_distribution.h"

namespace spume::foam::test {
namespace {

constexpr int kDraws = 4000;
const double kCritical = 1.63 / std::sqrt(kDraws);  // Kolmogorov-Smirnov at p = 0.01, seed fixed

/// Largest distance of the drawn radii from the distribution function `exact`.
template <typename Exact>
double distance(const RadiusDistribution& distribution, const Exact& exact) {
  std::vector<double> radii;
  for (std::uint64_t n = 0; n < kDraws; ++n) {
    CounterRandom random(3, n, 7);
    radii.push_back(distribution.draw(random));
    EXPECT_GE(radii.back(), distribution.least);
    EXPECT_LE(radii.back(), distribution.most);
  }
  std::sort(radii.begin(), radii.end());
  double worst = 0;
  for (int k = 0; k < kDraws; ++k)
    worst = std::max({worst, std::abs(exact(radii[k]) - double(k) / kDraws),
                      std::abs(exact(radii[k]) - double(k + 1) / kDraws)});
  return worst;
}

TEST(RadiusDistribution, UniformIsUniform) {
  const RadiusDistribution uniform{RadiusLaw::uniform, 0, 0, 0, 1e-3, 3e-3};
  EXPECT_LT(distance(uniform, [](double r) { return (r - 1e-3) / 2e-3; }), kCritical);
}

TEST(RadiusDistribution, PowerLawHasItsExponent) {
  for (const double p : {-3.0, -1.0, 0.5, 2.0}) {
    const RadiusDistribution law{RadiusLaw::powerLaw, 0, 0, p, 1e-4, 1e-3};
    const auto primitive = [p](double r) { return p == -1 ? std::log(r) : std::pow(r, p + 1); };
    const double low = primitive(1e-4), high = primitive(1e-3);
    EXPECT_LT(distance(law, [&](double r) { return (primitive(r) - low) / (high - low); }), kCritical) << p;
  }
}

TEST(RadiusDistribution, LognormalIsCutNotPiledUpAtTheEnds) {
  const RadiusDistribution law{RadiusLaw::lognormal, 1e-3, 0.5, 0, 0.5e-3, 1.5e-3};
  const auto normal = [](double r) { return 0.5 * std::erfc(-std::log(r / 1e-3) / 0.5 / std::sqrt(2.0)); };
  const double low = normal(0.5e-3), high = normal(1.5e-3);
  EXPECT_LT(distance(law, [&](double r) { return (normal(r) - low) / (high - low); }), kCritical);
}

TEST(RadiusDistribution, NoWidthGivesOneRadius) {
  CounterRandom random(1, 2, 3);
  EXPECT_EQ((RadiusDistribution{RadiusLaw::uniform, 0, 0, 0, 2e-3, 2e-3}.draw(random)), 2e-3);
  EXPECT_EQ((RadiusDistribution{RadiusLaw::lognormal, 2e-3, 0, 0, 1e-3, 3e-3}.draw(random)), 2e-3);
}

}  // namespace
}  // namespace spume::foam::test
