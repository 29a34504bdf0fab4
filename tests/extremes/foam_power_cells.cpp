#include <gtest/gtest.h>

#include "foam/power_cells.h"
#include "tests/support/foam_balls.h"

namespace spume::foam::test {
namespace {

using Eigen::Vector3d;

constexpr double kRelative = 1e-10;  ///< round-off of sums and the square of the jitter

TEST(PowerCellsExtremes, NoBubblesGiveEmptyLists) {
  FoamTopology t = powerCellsOf(randomFoam(4, .1, 2, 1, 1));
  PowerCells().compute({}, {}, {}, t);
  EXPECT_TRUE(t.films.empty() && t.overlaps.empty() && t.volume.empty() && t.hidden.empty());
}

TEST(PowerCellsExtremes, OneBubbleIsItsBall) {
  Balls balls;
  balls.add({1, 2, 3}, 2);
  const FoamTopology t = powerCellsOf(balls);
  EXPECT_NEAR(t.volume[0], ballVolume(2), kRelative);
  EXPECT_NEAR(t.freeArea[0], 16 * std::numbers::pi, kRelative);
  EXPECT_EQ(t.filmArea[0], 0);
}

TEST(PowerCellsExtremes, CollinearBallsLoseTheirCaps) {
  Balls balls;
  for (int i = 0; i < 5; ++i) balls.add({1.5 * i, 0, 0}, 1);
  const FoamTopology t = powerCellsOf(balls);
  for (int i = 0; i < 5; ++i)
    EXPECT_NEAR(t.volume[i], ballVolume(1) - (i % 4 == 0 ? 1 : 2) * capVolume(1, .25), kRelative);
  EXPECT_EQ(t.films.size(), 4u);
}

TEST(PowerCellsExtremes, ACoplanarSquareIsSymmetric) {
  Balls balls;
  for (int i = 0; i < 4; ++i) balls.add({1.0 * (i & 1), 1.0 * (i >> 1), 0}, 1);
  const FoamTopology t = powerCellsOf(balls);
  for (int i = 1; i < 4; ++i) {
    EXPECT_NEAR(t.volume[i], t.volume[0], kRelative);
    EXPECT_NEAR(t.freeArea[i], t.freeArea[0], 10 * kRelative);
  }
}

TEST(PowerCellsExtremes, CoincidentBallsKeepOneCell) {
  Balls balls;
  for (int i = 0; i < 100; ++i) balls.add({1, 1, 1}, 1);
  const FoamTopology t = powerCellsOf(balls);
  EXPECT_EQ(std::count(t.hidden.begin(), t.hidden.end(), 0), 1);
  EXPECT_NEAR(total(t.volume), ballVolume(1), kRelative);
  EXPECT_EQ(t.overlaps.size(), 4950u);
  EXPECT_TRUE(t.films.empty());
}

TEST(PowerCellsExtremes, NearlyCoincidentBallsShareTheirUnion) {
  for (double apart : {1e-14, 1e-11, 1e-9, 1e-7, 1e-5, 1e-3}) {
    Balls balls;
    balls.add({0, 0, 0}, 1), balls.add({apart, 0, 0}, 1);
    const FoamTopology t = powerCellsOf(balls);
    const double exact = 2 * (ballVolume(1) - capVolume(1, 1 - apart / 2));
    EXPECT_NEAR(total(t.volume), exact, 1e-8) << apart;  // the jitter itself, where it decides
    EXPECT_GE(*std::min_element(t.volume.begin(), t.volume.end()), 0);
  }
}

TEST(PowerCellsExtremes, AContainedBallIsHiddenAndCutsNothing) {
  Balls balls;
  balls.add({0, 0, 0}, 1), balls.add({.6, 0, 0}, .3), balls.add({1.5, 0, 0}, 1);
  const FoamTopology t = powerCellsOf(balls);
  EXPECT_EQ(t.hidden, (std::vector<std::uint8_t>{0, 1, 0}));
  EXPECT_EQ(t.volume[1], 0);
  EXPECT_NEAR(t.volume[0], ballVolume(1) - capVolume(1, .25), kRelative);
  ASSERT_EQ(t.films.size(), 1u);
  EXPECT_EQ(t.films[0].j, 2);
  ASSERT_EQ(t.overlaps.size(), 3u);
  EXPECT_EQ(t.overlaps[0].j, 1);
  EXPECT_EQ(t.overlaps[0].film, -1);
}

/// Six balls cover a small one in their middle though none contains it.
TEST(PowerCellsExtremes, ABallCoveredByAUnionIsHidden) {
  Balls balls;
  balls.add({0, 0, 0}, .3);
  for (int axis = 0; axis < 3; ++axis)
    for (double side : {-1., 1.}) balls.add(.8 * side * Vector3d::Unit(axis), 1);
  const FoamTopology t = powerCellsOf(balls);
  EXPECT_EQ(t.hidden[0], 1);
  EXPECT_EQ(t.volume[0], 0);
  EXPECT_EQ(std::count(t.hidden.begin(), t.hidden.end(), 1), 1);
  for (const Film& film : t.films) EXPECT_NE(film.i, 0);
}

TEST(PowerCellsExtremes, TangentBallsAreWhole) {
  Balls balls;
  balls.add({0, 0, 0}, 1), balls.add({2, 0, 0}, 1), balls.add({0, 1.5, 0}, .5);
  const FoamTopology t = powerCellsOf(balls);
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(t.volume[i], ballVolume(balls.radius[i]), kRelative * ballVolume(balls.radius[i]));
}

TEST(PowerCellsExtremes, RatioThousandKeepsTheSmallCellsExact) {
  Balls balls;
  balls.add({0, 0, 0}, 1);
  const double small = 1e-3, d = 1.0002;
  for (int axis = 0; axis < 3; ++axis) balls.add(d * Vector3d::Unit(axis), small);
  const double h = (d - (1 - small) * ((1 + small) / d)) / 2;
  const double exact = ballVolume(small) - capVolume(small, small - h);
  const FoamTopology t = powerCellsOf(balls);
  constexpr double kSmallCell =
      1e-10;  // heights lose 3 digits to the large radius, and the jitter grows as much
  for (int i = 1; i < 4; ++i) EXPECT_NEAR(t.volume[i], exact, kSmallCell * exact);
  EXPECT_NEAR(t.volume[0], ballVolume(1) - 3 * capVolume(1, 1 - (d - h)), kRelative);
}

TEST(PowerCellsExtremes, LatticeOfEqualBallsIsSymmetric) {
  Balls balls;
  for (int i = 0; i < 64; ++i) balls.add({1.0 * (i & 3), 1.0 * (i >> 2 & 3), 1.0 * (i >> 4)}, .75);
  const FoamTopology t = powerCellsOf(balls);
  for (int i = 0; i < 64; ++i) {
    EXPECT_NEAR(t.volume[i], t.volume[63 - i], kRelative);
    EXPECT_NEAR(t.freeArea[i], t.freeArea[63 - i], 10 * kRelative);
  }
}

}  // namespace
}  // namespace spume::foam::test
