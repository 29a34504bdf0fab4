#include <gtest/gtest.h>

#include <limits>

#include "foam/errors.h"
#include "foam/power_diagram.h"
#include "tests/support/foam_balls.h"
#include "tests/support/foam_relaxed.h"

namespace spume::foam::test {
namespace {

using Eigen::Vector3d;

/// Round-off of both engines, in volumes of the ball; hulls of slivers and large neighbours cost some digits.
constexpr double kRelative = 1e-9;

FoamTopology powerDiagramOf(const Balls& balls) {
  FoamTopology topology;
  PowerDiagram().compute(balls.position, balls.radius, balls.id, topology);
  return topology;
}

void expectEnginesAgree(const Balls& balls) {
  const FoamTopology local = powerCellsOf(balls), global = powerDiagramOf(balls);
  EXPECT_EQ(local.hidden, global.hidden);
  ASSERT_EQ(local.overlaps.size(), global.overlaps.size());
  for (std::size_t p = 0; p < local.overlaps.size(); ++p) {
    const OverlapPair &a = local.overlaps[p], &b = global.overlaps[p];
    ASSERT_TRUE(a.i == b.i && a.j == b.j && a.film == b.film)
        << a.i << "," << a.j << " film " << a.film << "/" << b.film;
  }
  for (std::size_t f = 0; f < local.films.size(); ++f) {
    const Film &a = local.films[f], &b = global.films[f];
    const double r = std::min(balls.radius[a.i], balls.radius[a.j]);
    EXPECT_NEAR(a.area, b.area, 10 * kRelative * r * r) << a.i << "," << a.j;
    EXPECT_NEAR(a.height, b.height, kRelative * r);
  }
  for (std::size_t i = 0; i < balls.size(); ++i) {
    const double r = balls.radius[i];
    EXPECT_NEAR(local.volume[i], global.volume[i], kRelative * ballVolume(r)) << i;
    EXPECT_NEAR(local.freeArea[i], global.freeArea[i], 10 * kRelative * r * r) << i;
    EXPECT_NEAR(local.filmArea[i], global.filmArea[i], 10 * kRelative * r * r) << i;
  }
}

TEST(PowerDiagram, AgreesWithPowerCellsOnRandomFoams) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed)
    for (double fraction : {.1, .5, 1., 3.}) expectEnginesAgree(randomFoam(400, .5, 5, fraction, seed));
}

TEST(PowerDiagram, AgreesWithPowerCellsOnRelaxedFoams) {
  expectEnginesAgree(relaxedFoam(2000, .8, 1));
  expectEnginesAgree(relaxedFoam(2000, .4, 2));
}

TEST(PowerDiagram, AgreesWithPowerCellsUpToRatioThousand) {
  for (double clip : {5., 31.7}) expectEnginesAgree(randomFoam(1500, 1.6, clip, .8, 5));
  Balls balls;
  balls.add({0, 0, 0}, 1), balls.add({1.5, .1, 0}, .9);
  for (int i = 0; i < 500; ++i) {
    CounterRandom random(6, static_cast<std::uint64_t>(i), 2);
    const Vector3d direction(random.uniform() - .5, random.uniform() - .5, random.uniform() - .5);
    balls.add((1 + .0015 * (random.uniform() - .3)) * direction.normalized(), 1e-3);
  }
  expectEnginesAgree(balls);
}

TEST(PowerDiagram, AgreesWithPowerCellsOnLattices) {
  const std::vector<Vector3d> simple = {Vector3d::Zero()},
                              bodyCentred = {Vector3d::Zero(), Vector3d::Constant(.5)};
  const std::vector<Vector3d> faceCentred = {{0, 0, 0}, {0, .5, .5}, {.5, 0, .5}, {.5, .5, 0}};
  for (double r : {.5, .6, std::sqrt(.5), std::sqrt(.75), 1.}) expectEnginesAgree(latticeBlock(simple, 2, r));
  for (double r : {.45, .5, .55, .6}) expectEnginesAgree(latticeBlock(bodyCentred, 2, r));
  for (double r : {.3, .3535533905932738, .4, .5}) expectEnginesAgree(latticeBlock(faceCentred, 1, r));
}

TEST(PowerDiagram, AgreesWithPowerCellsOnRafts) {
  Balls square, hexagonal;
  for (int i = 0; i < 100; ++i) {
    square.add({1.0 * (i % 10), 0, 1.0 * (i / 10)}, .6);
    hexagonal.add({i % 10 + .5 * (i / 10 % 2), 0, std::sqrt(.75) * (i / 10)}, .6);
  }
  expectEnginesAgree(square);
  expectEnginesAgree(hexagonal);
}

TEST(PowerDiagram, AgreesWithPowerCellsOnDegenerateSets) {
  Balls line, coincident, contained, covered;
  for (int i = 0; i < 6; ++i) line.add({i * .7, i * .7, 0}, .6);
  for (int i = 0; i < 5; ++i) coincident.add({1, 1, 1}, 1);
  for (int i = 0; i < 3; ++i) coincident.add({2, 1 + .1 * i, 1}, .8);
  contained.add({0, 0, 0}, 1), contained.add({.6, 0, 0}, .3), contained.add({1.5, 0, 0}, 1);
  covered.add({0, 0, 0}, .3);
  for (int axis = 0; axis < 3; ++axis)
    for (double side : {-1., 1.}) covered.add(.8 * side * Vector3d::Unit(axis), 1);
  for (const Balls& balls : {line, coincident, contained, covered}) expectEnginesAgree(balls);
}

TEST(PowerDiagram, AgreesWithPowerCellsOnFewBalls) {
  Balls balls;
  for (int count = 0; count <= 5; ++count) {
    expectEnginesAgree(balls);
    balls.add({.8 * (count & 1), .7 * (count & 2), .3 * count}, .7 + .05 * count);
  }
}

/// CGAL goes along edges, and turns around them, as their addresses have it: sums must not.
TEST(PowerDiagram, DoesNotDependOnWhereMemoryLies) {
  const Balls balls = relaxedFoam(400, 0.4, 1);
  const FoamTopology expected = powerDiagramOf(balls);
  std::vector<std::vector<char>> holes;
  for (std::size_t turn = 1; turn <= 6; ++turn) {
    for (std::size_t k = 0; k < 400; ++k) holes.emplace_back(100 * turn + 7 * k);
    for (std::size_t k = 0; k < holes.size(); k += 2) holes[k] = {};
    const FoamTopology found = powerDiagramOf(balls);
    EXPECT_EQ(found.volume, expected.volume) << turn;
    EXPECT_EQ(found.freeArea, expected.freeArea) << turn;
    EXPECT_EQ(found.filmArea, expected.filmArea) << turn;
  }
}

TEST(PowerDiagram, EqualPairHasTheClosedForm) {
  Balls balls;
  balls.add({0, 0, 0}, 1), balls.add({1, 0, 0}, 1);
  const FoamTopology t = powerDiagramOf(balls);
  EXPECT_NEAR(t.volume[0], 9 * std::numbers::pi / 8, kRelative);
  EXPECT_NEAR(t.films.at(0).area, .75 * std::numbers::pi, kRelative);
}

TEST(PowerDiagram, EdgesOfASimplexAreAllPairs) {
  Balls balls;
  for (int i = 0; i < 4; ++i) balls.add(Vector3d(i == 1, i == 2, i == 3), .1);
  constexpr double kAll = std::numeric_limits<double>::infinity();
  EXPECT_EQ(alphaComplexEdges(balls.position, balls.radius, balls.id, kAll).size(), 6u);
}

/// Two balls of radius r, d apart, meet in the alpha complex once r^2 + alpha = (d/2)^2.
TEST(PowerDiagram, APairEntersTheAlphaComplexHalfway) {
  Balls balls;
  balls.add({0, 0, 0}, 1), balls.add({4, 0, 0}, 1);
  EXPECT_TRUE(alphaComplexEdges(balls.position, balls.radius, balls.id, 2.999).empty());
  EXPECT_EQ(alphaComplexEdges(balls.position, balls.radius, balls.id, 3.001).size(), 1u);
}

TEST(PowerDiagram, RejectsWhatIsNoBall) {
  FoamTopology out;
  EXPECT_THROW(PowerDiagram().compute({{0, 0, 0}}, {-1}, {0}, out), InvalidParameter);
}

}  // namespace
}  // namespace spume::foam::test
