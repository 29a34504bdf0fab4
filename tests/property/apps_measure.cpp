#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <unordered_map>

#include "tests/support/measured_foam.h"

namespace spume::apps::test {
namespace {

/// Round-off of sums over up to 100 films, relative to the bubble's whole sphere or ball.
constexpr double kRoundOff = 1e-12;

/// 100 000 overlapping balls of radii 1/3 to 3 mm in a mixed order of ids that are no indices.
Balls foamOfManyBubbles() {
  Balls balls = foam::test::randomFoam(100000, .4, 3, .8, 11);
  for (auto& x : balls.position) x *= 1e-3;
  for (auto& r : balls.radius) r *= 1e-3;
  for (auto& id : balls.id) id = 7919 * id % 100003 + 5000000000u;  // a permutation: 100003 is prime
  return balls;
}

/// The written rows, each bubble's contacts summed.
struct Sums {
  double filmArea = 0, pyramids = 0;  ///< pyramids: sum of signed height x area [m^3]
  int films = 0;
};

class MeasuredManyBubbles : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    balls = foamOfManyBubbles();
    foam = measured(balls);
    for (std::size_t i = 0; i < balls.size(); ++i) index[balls.id[i]] = i;
    sums.resize(balls.size());
    for (const ContactRow& contact : foam.contacts) {
      addTo(index.at(contact.a), index.at(contact.b), contact);
      addTo(index.at(contact.b), index.at(contact.a), contact);
    }
  }

  /// Adds a film to the bubble on its side i.
  static void addTo(std::size_t i, std::size_t j, const ContactRow& contact) {
    const double d = contact.distance, ri = balls.radius[i], rj = balls.radius[j];
    sums[i].filmArea += contact.filmArea;
    sums[i].pyramids += contact.filmArea * (d * d + ri * ri - rj * rj) / (2 * d);
    ++sums[i].films;
  }

  static double sphere(std::size_t i) { return 4 * std::numbers::pi * balls.radius[i] * balls.radius[i]; }

  static inline Balls balls;
  static inline MeasuredFoam foam;
  static inline std::unordered_map<std::uint64_t, std::size_t> index;
  static inline std::vector<Sums> sums;
};

TEST_F(MeasuredManyBubbles, EveryBubbleHasItsRowInOrder) {
  ASSERT_EQ(foam.cells.size(), balls.size());
  for (std::size_t i = 0; i < balls.size(); ++i) ASSERT_EQ(foam.cells[i].id, balls.id[i]);
}

TEST_F(MeasuredManyBubbles, ContactsAreOrderedAndUnique) {
  ASSERT_GT(foam.contacts.size(), balls.size());
  for (std::size_t k = 0; k < foam.contacts.size(); ++k) {
    const ContactRow& contact = foam.contacts[k];
    ASSERT_LT(contact.a, contact.b);
    if (k == 0) continue;
    const ContactRow& last = foam.contacts[k - 1];
    ASSERT_TRUE(last.a < contact.a || (last.a == contact.a && last.b < contact.b)) << "row " << k;
  }
}

TEST_F(MeasuredManyBubbles, FilmsOfTheContactsAreThoseOfTheCells) {
  for (std::size_t i = 0; i < balls.size(); ++i) {
    ASSERT_EQ(sums[i].films, foam.cells[i].films) << "bubble " << balls.id[i];
    ASSERT_NEAR(sums[i].filmArea, foam.cells[i].filmArea, kRoundOff * sphere(i));
  }
}

TEST_F(MeasuredManyBubbles, DistancesAreThoseOfTheCentres) {
  for (const ContactRow& contact : foam.contacts) {
    const double d = (balls.position[index.at(contact.a)] - balls.position[index.at(contact.b)]).norm();
    ASSERT_NEAR(contact.distance, d, kRoundOff * d);
  }
}

/// A cell is made of cones over its films and its part of the sphere: V = (sum h A + r S) / 3. The engine
/// removes its tie-breaking jitter (1e-9) from each term to first order.
TEST_F(MeasuredManyBubbles, VolumesFollowFromAreas) {
  constexpr double kJitterSquared = 1e-10;
  for (std::size_t i = 0; i < balls.size(); ++i) {
    const double r = balls.radius[i], cones = (sums[i].pyramids + r * foam.cells[i].freeArea) / 3;
    ASSERT_NEAR(foam.cells[i].volume, cones, kJitterSquared * r * sphere(i)) << "bubble " << balls.id[i];
  }
}

TEST_F(MeasuredManyBubbles, HiddenBubblesHaveNothingAndOthersSomething) {
  int hidden = 0;
  for (std::size_t i = 0; i < balls.size(); ++i) {
    const CellRow& cell = foam.cells[i];
    hidden += cell.hidden;
    ASSERT_EQ(cell.hidden == 1, cell.films == 0 && cell.freeArea == 0);
    ASSERT_LE(cell.freeArea, (1 + kRoundOff) * sphere(i));
    ASSERT_LE(cell.volume, (1 + kRoundOff) * sphere(i) * balls.radius[i] / 3);
  }
  EXPECT_GT(hidden, 0);  // random places: some balls lie in others
}

}  // namespace
}  // namespace spume::apps::test
