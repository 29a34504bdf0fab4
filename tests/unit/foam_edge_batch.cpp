#include <gtest/gtest.h>

#include <cmath>
#include <deque>
#include <numbers>

#include "foam/edge_batch.h"

namespace spume::foam::test {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kRoundOff = 1e-13;  ///< of sums of up to 21 terms of order 1

constexpr double kRadius = 1, kHeight = 0.6, kFarRadius = 1.2;
const double kDiscRadius = std::sqrt(kRadius * kRadius - kHeight * kHeight);
const double kFarHeight = std::sqrt(kFarRadius * kFarRadius - kDiscRadius * kDiscRadius);
const DiscBalls kBalls{kRadius, 0, kHeight, 0, kFarRadius, kFarHeight};

/// The disc z = 0.6 of the unit ball, cut by `sides` upright planes at a distance: a regular polygon where
/// that is below rho cos(pi/sides), a disc with that many bites taken where it is above.
CuttingPlanes polygonOf(int sides, double distance) {
  CuttingPlanes planes;
  planes.resize(static_cast<std::size_t>(sides) + 1);
  planes.nx[0] = planes.ny[0] = 0, planes.nz[0] = 1, planes.height[0] = kHeight;
  for (int k = 1; k <= sides; ++k) {
    const double angle = 2 * kPi * k / sides;
    planes.nx[k] = std::cos(angle), planes.ny[k] = std::sin(angle), planes.nz[k] = 0;
    planes.height[k] = distance;
  }
  return planes;
}

bool addTo(EdgeBatch& batch, const CuttingPlanes& planes, FilmShape& film) {
  constexpr std::int32_t kFace = 0;
  DiscLines lines;
  lines.find(planes, {&kFace, 1}, kRadius);
  if (!lines.isLeft(0)) return false;
  lines.scale();
  return batch.add(lines, 0, kBalls, film);
}

FilmShape alone(const CuttingPlanes& planes) {
  EdgeBatch batch;
  FilmShape film;
  EXPECT_TRUE(addTo(batch, planes, film));
  batch.flush();
  return film;
}

TEST(EdgeBatch, ADiscWithoutLinesIsWhole) {
  const FilmShape film = alone(polygonOf(0, 0));
  EXPECT_NEAR(film.area, kPi * kDiscRadius * kDiscRadius, kRoundOff);
  EXPECT_NEAR(film.arc, 2 * kPi, kRoundOff);
  EXPECT_NEAR(film.solidNear, 2 * kPi * (1 - kHeight / kRadius), kRoundOff);
  EXPECT_NEAR(film.solidFar, 2 * kPi * (1 - kFarHeight / kFarRadius), kRoundOff);
}

TEST(EdgeBatch, AClosedDiscIsItsPolygon) {
  for (int sides = 3; sides <= 20; ++sides) {
    const double distance = 0.9 * kDiscRadius * std::cos(kPi / sides);
    const FilmShape film = alone(polygonOf(sides, distance));
    EXPECT_NEAR(film.area, sides * distance * distance * std::tan(kPi / sides), kRoundOff) << sides;
    EXPECT_EQ(film.arc, 0) << sides;
  }
}

TEST(EdgeBatch, EachBiteTakesASegment) {
  for (int sides = 1; sides <= 20; ++sides) {
    const double half = 0.8 * kPi / sides, rho2 = kDiscRadius * kDiscRadius;  // of the angle of a bite
    if (half >= kPi / 2) continue;
    const FilmShape film = alone(polygonOf(sides, kDiscRadius * std::cos(half)));
    EXPECT_NEAR(film.area, rho2 * (kPi - sides * (half - std::sin(half) * std::cos(half))), kRoundOff)
        << sides;
    EXPECT_NEAR(film.arc, 2 * kPi - 2 * sides * half, kRoundOff) << sides;
  }
}

TEST(EdgeBatch, OnePlaneCanTakeAll) {
  CuttingPlanes planes = polygonOf(1, -1.01 * kDiscRadius);
  FilmShape film;
  EdgeBatch batch;
  EXPECT_FALSE(addTo(batch, planes, film));
}

TEST(EdgeBatch, SeveralPlanesCanTakeAll) {
  CuttingPlanes planes = polygonOf(4, -0.1 * kDiscRadius);
  FilmShape film;
  EdgeBatch batch;
  EXPECT_FALSE(addTo(batch, planes, film));
}

/// More edges than a batch holds, with any number of them per disc: none sees the others.
TEST(EdgeBatch, ADiscInABatchIsThatDiscAlone) {
  constexpr double kLanes =
      4e-16;  // sums are in the same order; only contraction of the same code may differ
  EdgeBatch batch;
  std::deque<std::pair<CuttingPlanes, FilmShape>> discs;
  for (int round = 0; round < 4; ++round)
    for (int sides = 0; sides <= 20; ++sides) {
      if (sides == 1 || sides == 2) continue;
      discs.push_back({polygonOf(sides, (0.5 + 0.1 * round) * kDiscRadius), {}});
      ASSERT_TRUE(addTo(batch, discs.back().first, discs.back().second));
    }
  batch.flush();
  for (const auto& [planes, film] : discs) {
    const FilmShape expected = alone(planes);
    EXPECT_NEAR(film.area, expected.area, kLanes);
    EXPECT_NEAR(film.arc, expected.arc, kLanes);
    EXPECT_NEAR(film.solidNear, expected.solidNear, kLanes);
    EXPECT_NEAR(film.solidFar, expected.solidFar, kLanes);
  }
}

}  // namespace
}  // namespace spume::foam::test
