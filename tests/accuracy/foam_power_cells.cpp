#include <gtest/gtest.h>

#include "foam/power_cells.h"
#include "tests/support/foam_balls.h"

namespace spume::foam::test {
namespace {

using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;
/// Round-off: sums of about 50 terms of size r^3, and the square of the tie-breaking jitter; the tabled
/// values carry 12 decimals.
constexpr double kRelative = 1e-10;
constexpr double kTableDigits = 6e-13;

void expectVolumes(const Balls& balls, const std::vector<double>& cells) {
  const FoamTopology topology = powerCellsOf(balls);
  for (std::size_t i = 0; i < cells.size(); ++i)
    EXPECT_NEAR(topology.volume[i], cells[i], kRelative * cells[i] + kTableDigits) << "ball " << i;
}

Balls ballsAt(const std::vector<std::pair<Vector3d, double>>& list) {
  Balls balls;
  for (const auto& [x, r] : list) balls.add(x, r);
  return balls;
}

Balls regularSimplex(int corners, double edge, double radius) {
  const std::vector<Vector3d> corner = {
      {0, 0, 0}, {1, 0, 0}, {.5, std::sqrt(.75), 0}, {.5, std::sqrt(1. / 12), std::sqrt(2. / 3)}};
  Balls balls;
  for (int i = 0; i < corners; ++i) balls.add(edge * corner[i], radius);
  return balls;
}

TEST(PowerCells, V1EqualPair) { expectVolumes(regularSimplex(2, 1, 1), {9 * kPi / 8, 9 * kPi / 8}); }

TEST(PowerCells, V2UnequalPair) {
  expectVolumes(ballsAt({{{0, 0, 0}, 1}, {{1.2, 0, 0}, .6}}), {4.135421914770, .790595366059});
}

TEST(PowerCells, V3PlaneThroughTheSmallCentre) {
  expectVolumes(ballsAt({{{0, 0, 0}, 1}, {{std::sqrt(.75), 0, 0}, .5}}), {4.134919387157, kPi / 12});
}

TEST(PowerCells, V4SmallCentreOutsideItsCell) {
  expectVolumes(ballsAt({{{0, 0, 0}, 1}, {{.85, 0, 0}, .3}}), {4.183902857694, .026768770924});
}

TEST(PowerCells, V5Triangle) {
  expectVolumes(regularSimplex(3, 1, 1), {3.103736710859, 3.103736710859, 3.103736710859});
}

TEST(PowerCells, V6Tetrahedron) {
  expectVolumes(regularSimplex(4, 1, 1), {2.791585698220, 2.791585698220, 2.791585698220, 2.791585698220});
}

TEST(PowerCells, V7ThreeUnequalBalls) {
  expectVolumes(ballsAt({{{0, 0, 0}, 1}, {{1.1, .2, .1}, .8}, {{.3, .9, -.2}, .6}}),
                {3.873052378227, 1.797791485346, .603448288996});
}

TEST(PowerCells, V10CubicLattice) {
  const std::vector<Vector3d> simple = {Vector3d::Zero()};
  expectVolumes(latticeBlock(simple, 1, .6), {ballVolume(.6) - 6 * capVolume(.6, .1)});
  for (double r : {std::sqrt(.75), .9, 1.1}) expectVolumes(latticeBlock(simple, 3, r), {1});
}

TEST(PowerCells, V11BodyCentredLattice) {
  const std::vector<Vector3d> bodyCentred = {Vector3d::Zero(), Vector3d::Constant(.5)};
  expectVolumes(latticeBlock(bodyCentred, 2, .45), {.378480943723});
  expectVolumes(latticeBlock(bodyCentred, 2, .5), {.469727957969});
  expectVolumes(latticeBlock(bodyCentred, 2, .55), {.499930264393});
  expectVolumes(latticeBlock(bodyCentred, 2, .6), {.5});
}

TEST(PowerCells, KelvinCellHasTheAreaOfTheTruncatedOctahedron) {
  const FoamTopology t = powerCellsOf(latticeBlock({Vector3d::Zero(), Vector3d::Constant(.5)}, 2, .6));
  const double edge = std::sqrt(.125);  // 8 sqrt(2) a^3 = 1/2
  const double exact = (6 + 12 * std::sqrt(3.)) * edge * edge;
  EXPECT_NEAR(t.filmArea[0], exact, kRelative * exact);
  EXPECT_EQ(t.freeArea[0], 0);
}

TEST(PowerCells, EqualPairsOfEveryWetnessHaveTheCapVolume) {
  for (double wetness : {0., .2, .4, .6, .8}) {
    const double l = std::sqrt(1 + 3 * wetness);
    const double exact = ballVolume(1) - capVolume(1, 1 - l / 2);
    expectVolumes(regularSimplex(2, l, 1), {exact, exact});
  }
}

/// Scaling all lengths shows 3 N V / r = total area for balls cut by planes (accuracy, "Clusters").
TEST(PowerCells, DryClustersHaveTheTabledTotalArea) {
  constexpr double kSixDecimals = 1e-6;
  const double area[] = {12.566371, 21.205750, 27.933630, 33.499028};
  for (int n = 1; n <= 4; ++n) {
    const FoamTopology t = powerCellsOf(regularSimplex(n, 1, 1));
    EXPECT_NEAR(total(t.freeArea) + total(t.filmArea) / 2, area[n - 1], kSixDecimals) << n;
  }
}

TEST(PowerCells, ScaleDoesNotMatterFromATenthOfAMillimetreToHundredMetres) {
  for (double scale : {1e-4, 1e-2, 1e2}) {
    const FoamTopology t = powerCellsOf(regularSimplex(4, scale, scale));
    for (double v : t.volume) EXPECT_NEAR(v / std::pow(scale, 3), 2.791585698220, kRelative * 2.8);
  }
}

}  // namespace
}  // namespace spume::foam::test
