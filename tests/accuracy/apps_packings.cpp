// The jamming transition of soft balls (accuracy, 4.1: G11) on small packings.
#include <gtest/gtest.h>

#include <cmath>

#include "apps/reproduce/power_law.h"
#include "apps/reproduce/shear_modulus.h"
#include "apps/reproduce/soft_packing.h"

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

TEST(SoftPacking, KeepsItsFraction) {
  SoftPacking packing({.count = 50, .ratio = 1.4, .fraction = 0.6});
  EXPECT_NEAR(packing.fraction(), 0.6, 1e-12);
  packing.setFraction(0.7);
  EXPECT_NEAR(packing.fraction(), 0.7, 1e-12);
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
