// The jamming transition of soft balls and of discs that hold the areas of their cells (accuracy, 4.1: G11,
// G13) on small packings.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "apps/reproduce/disc_cells.h"
#include "apps/reproduce/foam_relaxation.h"
#include "apps/reproduce/jamming_path.h"
#include "apps/reproduce/power_law.h"
#include "apps/reproduce/shear_modulus.h"
#include "apps/reproduce/soft_packing.h"
#include "foam/errors.h"

namespace spume::apps {
namespace {

constexpr double kJams = 0.639, kFactor = 7.7;  // fraction and Z0 of Z = 6 + Z0 dphi^0.5 [OHern 2003]
constexpr int kBalls = 300;

TEST(SoftPacking, BelowTheTransitionNothingTouches) {
  SoftPacking packing({.count = kBalls, .fraction = 0.55});
  EXPECT_TRUE(packing.relax());
  EXPECT_LT(packing.census().pressure, 1e-6);
  EXPECT_EQ(packing.census().held, 0);
}

TEST(SoftPacking, AboveItContactsGrowWithTheRootOfTheFractionBeyond) {
  // Transitions of 300 balls lie within 0.01 of that of many; what this and 300 balls do to the law.
  constexpr double kSmallPacking = 0.06;
  for (const double fraction : {0.68, 0.72}) {
    SoftPacking packing({.count = kBalls, .fraction = fraction});
    EXPECT_TRUE(packing.relax());
    const double expected = 6 + kFactor * std::sqrt(fraction - kJams);
    EXPECT_NEAR(packing.census().contacts, expected, kSmallPacking * expected) << fraction;
    EXPECT_GT(packing.census().held, 0.95);
  }
}

TEST(SoftPacking, PressureIsThatOfTheSpringsOfALatticeOfTwo) {
  // Two discs in a square box whose edge is a little less than twice their diameter along the diagonal: each
  // touches the four images of the other, all alike.
  SoftPacking packing({.count = 2, .dimensions = 2, .fraction = 0.9, .seed = 3});
  EXPECT_TRUE(packing.relax());
  const double edge = packing.edge(), apart = edge / std::sqrt(2.0);
  ASSERT_LT(apart, 2);
  const double exact = 4 * (2 - apart) * apart / (2 * edge * edge);
  EXPECT_NEAR(packing.census().pressure, exact, 1e-4 * exact);  // at rest to 1e-5 of a push
  EXPECT_EQ(packing.census().contacts, 4);
}

/// The same by steps of the foam, with images of the discs beside the box.
TEST(FoamRelaxation, BringsTheLatticeOfTwoToTheSamePressure) {
  SoftPacking packing({.count = 2, .dimensions = 2, .fraction = 0.9, .seed = 3});
  EXPECT_FALSE(packing.isAtRest());
  EXPECT_TRUE(relaxAsFoam(packing));
  const double edge = packing.edge(), apart = edge / std::sqrt(2.0);
  const double exact = 4 * (2 - apart) * apart / (2 * edge * edge);
  EXPECT_NEAR(packing.census().pressure, exact, 1e-4 * exact);  // at rest to 1e-5 of a push
  EXPECT_EQ(packing.census().contacts, 4);
}

/// What the foam leaves at rest is at rest for the packing's own springs, which know the periodic box.
TEST(FoamRelaxation, LeavesAJammedPackingWithoutNetForces) {
  SoftPacking packing({.count = 60, .fraction = 0.72});
  ASSERT_TRUE(relaxAsFoam(packing));
  EXPECT_LE(packing.unrest(), SoftPacking::kAtRest);
  EXPECT_GT(packing.census().contacts, 6);
  const std::vector<Eigen::Vector3d> settled = packing.position();
  EXPECT_TRUE(packing.relax());
  EXPECT_EQ(packing.position(), settled);
}

TEST(FoamRelaxation, IsNotForCellsThatHoldTheirAreas) {
  SoftPacking packing({.count = 2, .dimensions = 2, .fraction = 0.9, .seed = 3});
  ASSERT_TRUE(packing.relax());
  packing.holdAreas();
  EXPECT_THROW(relaxAsFoam(packing), foam::InvalidParameter);
}

TEST(SoftPacking, KeepsItsFraction) {
  SoftPacking packing({.count = 50, .ratio = 1.4, .fraction = 0.6});
  EXPECT_NEAR(packing.fraction(), 0.6, 1e-12);
  packing.setFraction(0.7);
  EXPECT_NEAR(packing.fraction(), 0.7, 1e-12);
}

constexpr double kRoundOff = 1e-14;

/// What a line at a height cuts off a disc of radius r.
double segment(double r, double height) {
  return r * r * std::acos(height / r) - height * std::sqrt(r * r - height * height);
}

/// Lines at one height around a disc, at equal angles.
std::vector<CuttingLine> linesAround(int count, double height) {
  std::vector<CuttingLine> lines;
  for (int k = 0; k < count; ++k) {
    const double angle = 2 * std::numbers::pi * k / count;
    lines.push_back({{std::cos(angle), std::sin(angle)}, height});
  }
  return lines;
}

TEST(CutDisc, LosesASegmentToALineOnEitherSideOfItsCentre) {
  DiscCell cell;
  for (const double height : {0.9, 0.3, 0.0, -0.4}) {
    cutDisc(1, linesAround(1, height), cell);
    EXPECT_NEAR(cell.area, std::numbers::pi - segment(1, height), kRoundOff) << height;
    EXPECT_NEAR(cell.rim, 2 * (std::numbers::pi - std::acos(height)), kRoundOff) << height;
    EXPECT_NEAR(cell.edge[0], 2 * std::sqrt(1 - height * height), kRoundOff) << height;
  }
}

TEST(CutDisc, KeepsTheRimBetweenLinesThatDoNotMeetInIt) {
  DiscCell cell;
  cutDisc(2, linesAround(4, 1.6), cell);
  EXPECT_NEAR(cell.area, 4 * std::numbers::pi - 4 * segment(2, 1.6), 4 * kRoundOff);
  EXPECT_NEAR(cell.rim, 4 * std::numbers::pi - 16 * std::acos(0.8), 4 * kRoundOff);
}

TEST(CutDisc, IsThePolygonOfLinesThatMeetInIt) {
  DiscCell cell;
  cutDisc(2, linesAround(4, 1), cell);
  EXPECT_NEAR(cell.area, 4, 4 * kRoundOff);
  EXPECT_NEAR(cell.rim, 0, 4 * kRoundOff);
  std::vector<CuttingLine> lines = linesAround(4, 1);
  lines.push_back(
      {{std::sqrt(0.5), std::sqrt(0.5)}, 1.5});  // passes outside the square, but through the disc
  cutDisc(2, lines, cell);
  EXPECT_NEAR(cell.area, 4, 4 * kRoundOff);
  EXPECT_EQ(cell.edge[4], 0);
}

TEST(CutDisc, LeavesNothingBetweenLinesThatExcludeEachOther) {
  DiscCell cell;
  cutDisc(1, linesAround(2, -0.1), cell);
  EXPECT_EQ(cell.area, 0);
  EXPECT_EQ(cell.rim, 0);
}

/// Two discs like those of the lattice above: as cells, each is cut by four lines at half its spacing.
TEST(HeldAreas, SwellTheDiscsOfALatticeOfTwo) {
  SoftPacking packing({.count = 2, .dimensions = 2, .fraction = 0.9, .seed = 3});
  EXPECT_TRUE(packing.relax());
  packing.holdAreas();
  EXPECT_TRUE(packing.relax());
  const double edge = packing.edge(), apart = edge / std::sqrt(2.0), r = packing.radius(0);
  EXPECT_GT(r, 1.01);
  // Areas are held to 1e-10; places, at rest to 1e-5 of a push of 0.2, move the lines of two sides against
  // each other, which is of second order.
  EXPECT_NEAR(std::numbers::pi * r * r - 4 * segment(r, apart / 2), std::numbers::pi, 1e-9);
  const double exact = 4 * (2 * r - apart) * apart / (2 * edge * edge);
  EXPECT_NEAR(packing.census().pressure, exact, 1e-4 * exact);  // at rest to 1e-5 of a push
  EXPECT_EQ(packing.census().contacts, 4);
}

TEST(HeldAreas, AreForDiscsOnly) {
  SoftPacking packing({.count = 10});
  EXPECT_THROW(packing.holdAreas(), foam::InvalidParameter);
}

/// Where a linear law would be 1. At 1e-3 beyond jamming 200 discs have 10 contacts too many, give or take
/// their root: that moves an exponent from a fit over two decades by 0.06, and with that three at most come
/// from 0.5 itself.
TEST(HeldAreas, LeaveContactsToGrowWithTheRootOfTheShareBeyond) {
  constexpr int kDiscs = 200;
  constexpr double kSmallPacking = 0.2;
  SoftPacking foam({.count = kDiscs, .dimensions = 2, .ratio = 1.4, .fraction = 0.94});
  EXPECT_TRUE(foam.relax());
  foam.holdAreas();
  const JammingPath path(foam, 1e-3);
  EXPECT_TRUE(path.settled);
  EXPECT_LT(path.worstArea, 1e-9);
  PowerLaw excess;
  for (const auto& [fraction, census] : path.states)
    excess.add(fraction - path.jams, excessContacts(census, kDiscs, 2));
  EXPECT_NEAR(excess.exponent(), 0.5, kSmallPacking);
}

/// A crystal of springs of length 1 and stiffness 1 between nearest neighbours.
struct Crystal {
  std::vector<SoftPacking::Contact> contacts;
  std::vector<Eigen::Vector3d> place;
  double volume;

  /// `cell`: the edges of a box, repeated 3 times along each; `basis`: balls in it.
  Crystal(const Eigen::Vector3d& cell, const std::vector<Eigen::Vector3d>& basis) : volume(27 * cell.prod()) {
    for (int n = 0; n < 27; ++n)
      for (const auto& x : basis)
        place.push_back(x + cell.cwiseProduct(Eigen::Vector3d(n % 3, n / 3 % 3, n / 9)));
    for (int j = 0; j < static_cast<int>(place.size()); ++j)
      for (int i = 0; i < j; ++i) connect(i, j, 3 * cell);
  }
  void connect(int i, int j, const Eigen::Vector3d& box) {
    Eigen::Vector3d apart = place[j] - place[i];
    for (int axis = 0; axis < 3; ++axis) apart[axis] -= box[axis] * std::round(apart[axis] / box[axis]);
    if (std::abs(apart.norm() - 1) < 1e-9) contacts.push_back({i, j, 0, 1, apart});
  }
  double shearModulus() const { return apps::shearModulus(contacts, place.size(), 3, volume); }
};

TEST(ShearModulus, OfCubicCrystalsIsC44OfNearestNeighbours) {
  const double a = std::sqrt(2.0);
  const Crystal fcc({a, a, a}, {{0, 0, 0}, {0, a / 2, a / 2}, {a / 2, 0, a / 2}, {a / 2, a / 2, 0}});
  EXPECT_NEAR(fcc.shearModulus(), 1 / std::sqrt(2.0), 1e-12);  // k/(sqrt(2) d)
}

/// Its balls answer a shear by moving against each other: C66 : C44 is 9 : 8 [Born and Huang 1954], where
/// the bulk modulus, that of the cubic crystal, is 16 in the same units.
TEST(ShearModulus, OfTheHexagonalCrystalHasItsBallsMove) {
  const double width = std::sqrt(3.0), height = std::sqrt(8.0 / 3), unit = std::sqrt(2.0) / 24;
  const Crystal hcp(
      {1, width, height},
      {{0, 0, 0}, {.5, width / 2, 0}, {.5, width / 6, height / 2}, {0, width * 2 / 3, height / 2}});
  EXPECT_NEAR(hcp.shearModulus(), (9 + 8 + 8) / 3.0 * unit, 1e-12);
}

TEST(ShearModulus, VanishesWhereNothingTouches) { EXPECT_EQ(apps::shearModulus({}, 5, 3, 1), 0); }

TEST(PowerLaw, IsFoundExactly) {
  PowerLaw law;
  for (const double x : {0.1, 0.3, 2.0, 7.0}) law.add(x, 3 * std::pow(x, 0.7));
  EXPECT_NEAR(law.exponent(), 0.7, 1e-12);
  EXPECT_NEAR(law.factorOf(0.7), 3, 1e-12);
}

}  // namespace
}  // namespace spume::apps
