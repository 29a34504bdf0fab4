#include <gtest/gtest.h>

#include <limits>

#include "foam/errors.h"
#include "foam/lane_math.h"
#include "foam/power_cells.h"
#include "tests/support/foam_balls.h"

namespace spume::foam::test {
namespace {

using Eigen::Vector3d;

/// Central differences with step 1e-5 r: truncation 1e-10 of the third derivative, cancellation 1e-16/1e-5.
constexpr double kStep = 1e-5, kDerivative = 1e-6;

Balls cluster() {
  Balls balls;
  balls.add({0, 0, 0}, 1), balls.add({1.1, .2, .1}, .8), balls.add({.3, .9, -.2}, .6);
  balls.add({.2, .3, .9}, .5), balls.add({-.4, -.7, .6}, .7), balls.add({.85, -.4, .3}, .3);
  return balls;
}

double filmArea(const FoamTopology& topology, int i, int j, double* distance) {
  for (const Film& film : topology.films)
    if (film.i == std::min(i, j) && film.j == std::max(i, j)) return *distance = film.distance, film.area;
  return *distance = 1, 0;
}

TEST(PowerCells, VolumeByWeightIsFilmAreaOverTwiceTheDistance) {
  const Balls balls = cluster();
  const FoamTopology at = powerCellsOf(balls);
  for (std::size_t j = 0; j < balls.size(); ++j) {
    Balls more = balls, less = balls;
    const double w = balls.radius[j] * balls.radius[j];
    more.radius[j] = std::sqrt(w + kStep), less.radius[j] = std::sqrt(w - kStep);
    const FoamTopology up = powerCellsOf(more), down = powerCellsOf(less);
    for (std::size_t i = 0; i < balls.size(); ++i) {
      double expected = 0;
      for (std::size_t k = 0; k < balls.size(); ++k) {
        double d;
        const double area = i == k ? 0 : filmArea(at, static_cast<int>(i), static_cast<int>(k), &d);
        if (area > 0 && i == j) expected += area / (2 * d);
        if (area > 0 && k == j && i != j) expected -= area / (2 * d);
      }
      if (i == j) expected += at.freeArea[i] / (2 * balls.radius[i]);
      EXPECT_NEAR((up.volume[i] - down.volume[i]) / (2 * kStep), expected, kDerivative) << i << " by " << j;
    }
  }
}

TEST(PowerCells, V2DerivativesAreTheTabledOnes) {
  Balls balls;
  balls.add({0, 0, 0}, 1), balls.add({1.2, 0, 0}, .6);
  const FoamTopology t = powerCellsOf(balls);
  constexpr double kTable = 1e-9;  // nine decimals
  const double slope = t.films[0].area / (2 * t.films[0].distance);
  EXPECT_NEAR(slope, .325794794, kTable);
  EXPECT_NEAR(slope + t.freeArea[1] / (2 * .6), 3.257947937, kTable);
}

/// Pushing every surface outwards grows the union by its free area: d(sum V)/dr_i = S_i.
TEST(PowerCells, UnionByRadiusIsTheFreeArea) {
  const Balls balls = cluster();
  const FoamTopology at = powerCellsOf(balls);
  for (std::size_t i = 0; i < balls.size(); ++i) {
    Balls more = balls, less = balls;
    more.radius[i] += kStep, less.radius[i] -= kStep;
    const double slope = (total(powerCellsOf(more).volume) - total(powerCellsOf(less).volume)) / (2 * kStep);
    EXPECT_NEAR(slope, at.freeArea[i], kDerivative);
  }
}

/// Only the jitter differs between the two sets of ids, and it is undone to first order: its square is left.
TEST(PowerCells, TheJitterLeavesNoTraceInVolumesAndAreas) {
  constexpr double kSquareOfJitter = 1e-13;  // 1e-18 would do; the rest is round-off
  Balls balls = cluster();
  const FoamTopology a = powerCellsOf(balls);
  for (auto& id : balls.id) id = 1000 - 7 * id;
  const FoamTopology b = powerCellsOf(balls);
  for (std::size_t i = 0; i < balls.size(); ++i) {
    EXPECT_NEAR(a.volume[i], b.volume[i], kSquareOfJitter);
    EXPECT_NEAR(a.freeArea[i], b.freeArea[i], 10 * kSquareOfJitter);
    EXPECT_NEAR(a.filmArea[i], b.filmArea[i], 10 * kSquareOfJitter);
  }
}

void expectSame(const FoamTopology& a, const FoamTopology& b, double relative) {
  ASSERT_EQ(a.films.size(), b.films.size());
  ASSERT_EQ(a.overlaps.size(), b.overlaps.size());
  for (std::size_t f = 0; f < a.films.size(); ++f) {
    EXPECT_EQ(a.films[f].i, b.films[f].i);
    EXPECT_EQ(a.films[f].j, b.films[f].j);
    EXPECT_NEAR(a.films[f].area, b.films[f].area, relative);
    EXPECT_NEAR(a.films[f].height, b.films[f].height, relative);
  }
  for (std::size_t i = 0; i < a.volume.size(); ++i) {
    EXPECT_NEAR(a.volume[i], b.volume[i], relative);
    EXPECT_NEAR(a.freeArea[i], b.freeArea[i], 10 * relative);
    EXPECT_EQ(a.hidden[i], b.hidden[i]);
  }
}

TEST(PowerCells, TranslationByThousandRadiiChangesNothing) {
  constexpr double kLostDigits = 1e-12;  // 1e3 x eps x about 5 for sums and slopes
  Balls moved = cluster();
  for (auto& x : moved.position) x += Vector3d(1e3, -1e3, 1e3);
  expectSame(powerCellsOf(cluster()), powerCellsOf(moved), kLostDigits);
}

TEST(PowerCells, QuarterTurnsChangeNothing) {
  constexpr double kRoundOff = 1e-14;
  Balls turned = cluster();
  for (int turn = 0; turn < 3; ++turn) {
    for (auto& x : turned.position) x = Vector3d(-x.y(), x.x(), x.z());
    for (auto& x : turned.position) x = Vector3d(x.z(), x.x(), x.y());
    expectSame(powerCellsOf(cluster()), powerCellsOf(turned), kRoundOff);
  }
}

TEST(PowerCells, OrderOfTheBubblesChangesNothing) {
  constexpr double kRoundOff = 1e-14;
  const Balls balls = cluster();
  Balls reversed;
  for (std::size_t i = balls.size(); i-- > 0;) reversed.add(balls.position[i], balls.radius[i]);
  std::reverse(reversed.id.begin(), reversed.id.end());
  const FoamTopology a = powerCellsOf(balls), b = powerCellsOf(reversed);
  ASSERT_EQ(a.films.size(), b.films.size());
  for (std::size_t i = 0; i < balls.size(); ++i)
    EXPECT_NEAR(a.volume[i], b.volume[balls.size() - 1 - i], kRoundOff);
}

TEST(PowerCells, HeightIsTheRadicalPlaneOfThePair) {
  for (const Film& film : powerCellsOf(cluster()).films) {
    const Balls balls = cluster();
    const double d = film.distance, wi = std::pow(balls.radius[film.i], 2),
                 wj = std::pow(balls.radius[film.j], 2);
    EXPECT_NEAR(film.height, (d * d + wi - wj) / (2 * d), 1e-14);
  }
}

TEST(PowerCells, ListsAreSortedAndPointToEachOther) {
  const FoamTopology t = powerCellsOf(randomFoam(300, .6, 5, 1, 21));
  std::size_t films = 0;
  for (std::size_t p = 0; p < t.overlaps.size(); ++p) {
    const OverlapPair& pair = t.overlaps[p];
    EXPECT_LT(pair.i, pair.j);
    if (p > 0) {
      EXPECT_LT(std::make_pair(t.overlaps[p - 1].i, t.overlaps[p - 1].j), std::make_pair(pair.i, pair.j));
    }
    if (pair.film < 0) continue;
    EXPECT_EQ(static_cast<std::size_t>(pair.film), films++);
    EXPECT_EQ(t.films[pair.film].i, pair.i);
    EXPECT_EQ(t.films[pair.film].j, pair.j);
  }
  EXPECT_EQ(films, t.films.size());
}

TEST(PowerCells, RejectsWhatIsNoBall) {
  PowerCells cells;
  FoamTopology out;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(cells.compute({{0, 0, 0}}, {1, 2}, {0}, out), InvalidParameter);
  EXPECT_THROW(cells.compute({{0, nan, 0}}, {1}, {0}, out), InvalidParameter);
  EXPECT_THROW(cells.compute({{0, 0, 0}}, {0}, {0}, out), InvalidParameter);
  EXPECT_THROW(cells.compute({{0, 0, 0}}, {nan}, {0}, out), InvalidParameter);
}

TEST(LaneMath, UpperAngleIsAtan2OfTheUpperHalfPlane) {
  constexpr double kTwoUlp = 4.5e-16;
  for (int i = 0; i <= 2000; ++i)
    for (double scale : {1e-150, 1e-9, 1., 1e9}) {
      const double angle = std::numbers::pi * i / 2000, y = scale * std::sin(angle),
                   x = scale * std::cos(angle);
      EXPECT_NEAR(upperAngle(y, x), std::atan2(y, x), kTwoUlp * std::max(1e-3, std::atan2(y, x))) << angle;
    }
  EXPECT_EQ(upperAngle(0.0, 0.0), 0);
}

}  // namespace
}  // namespace spume::foam::test
