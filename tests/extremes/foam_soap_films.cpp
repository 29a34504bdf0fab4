// Films of foams in which cells meet in more than fours, films vanish, or balls swallow each other.
#include <gtest/gtest.h>

#include "foam/soap_films.h"
#include "tests/foam_fixtures.h"

namespace spume::foam::test {
namespace {

using Eigen::Vector3d;

/// Relaxes and looks at what has come out: finite, no more area, volumes held to `mostOff`.
SoapFilms relaxed(const Balls& balls, double mostOff = 0.01) {
  BubbleStore bubbles;
  for (std::size_t i = 0; i < balls.size(); ++i) bubbles.add(bubbleAt(balls.position[i], balls.radius[i]));
  const FilmRelaxationSettings settings;
  SoapFilms films = soapFilms(bubbles, 2, settings);
  for (const FilmNode& node : films.network.nodes) EXPECT_TRUE(node.position.allFinite());
  for (const double p : films.report.pressure) EXPECT_TRUE(std::isfinite(p));
  EXPECT_LE(films.report.areaAfter, films.report.areaBefore * (1 + 1e-9));
  EXPECT_LT(films.report.worstVolume, mostOff);
  return films;
}

TEST(SoapFilms, OfACubicLatticeMeetInEights) {
  Balls balls;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      for (int k = 0; k < 4; ++k) balls.add({double(i), double(j), double(k)}, 0.95);
  EXPECT_GE(relaxed(balls).network.films.size(), 3u * 3 * 16);
}

TEST(SoapFilms, OfBubblesOnALineAreDiscs) {
  Balls balls;
  for (int i = 0; i < 6; ++i) balls.add({0.9 * i, 0, 0}, 0.6);
  EXPECT_EQ(relaxed(balls).network.films.size(), 5u);
}

TEST(SoapFilms, OfCoincidentAndSwallowedBubblesAreThoseOfTheOthers) {
  Balls balls;
  balls.add({0, 0, 0}, 1);
  balls.add({0, 0, 0}, 1);
  balls.add({0.1, 0, 0}, 0.3);
  balls.add({1.2, 0, 0}, 1);
  EXPECT_EQ(relaxed(balls).network.films.size(), 1u);
}

TEST(SoapFilms, OfBubblesAThousandTimesSmallerKeepTheirSize) {
  Balls balls;
  balls.add({0, 0, 0}, 1);
  balls.add({1.2, 0, 0}, 1);
  for (int n = 0; n < 12; ++n) {  // along the rim of the film between the two
    const double angle = n * std::numbers::pi / 6;
    balls.add({0.6, 0.8 * std::cos(angle), 0.8 * std::sin(angle)}, 1e-3);
  }
  EXPECT_GE(relaxed(balls).network.films.size(), 25u);
}

TEST(SoapFilms, OfRandomBallsOfAllSizesHoldTogether) {
  constexpr double kSlivers = 0.1;  // cells of a thousandth of their neighbours are the last to settle
  for (const std::uint64_t seed : {1, 2, 3}) relaxed(randomFoam(200, 1.0, 10, 1.2, seed), kSlivers);
}

}  // namespace
}  // namespace spume::foam::test
