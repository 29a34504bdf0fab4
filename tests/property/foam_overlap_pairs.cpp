#include <gtest/gtest.h>

#include <set>

#include "foam/overlap_pairs.h"
#include "foam/space_order.h"
#include "tests/support/foam_balls.h"

namespace spume::foam::test {
namespace {

using PairSet = std::set<std::pair<int, int>>;

bool overlaps(const Balls& balls, int i, int j) {
  const double reach = balls.radius[i] + balls.radius[j];
  return (balls.position[i] - balls.position[j]).squaredNorm() < reach * reach;
}

PairSet allOverlaps(const Balls& balls) {
  PairSet pairs;
  for (int i = 0; i < static_cast<int>(balls.size()); ++i)
    for (int j = i + 1; j < static_cast<int>(balls.size()); ++j)
      if (overlaps(balls, i, j)) pairs.insert({i, j});
  return pairs;
}

/// The overlaps among the candidates; checks the order of rows on the way.
PairSet listedOverlaps(const Balls& balls, const OverlapPairs& list) {
  PairSet pairs;
  for (int s = 0; s < list.size(); ++s)
    for (int slot = list.rowStart()[s], last = -1; slot < list.rowStart()[s + 1]; ++slot) {
      const int t = list.candidate()[slot], i = list.order()[s], j = list.order()[t];
      EXPECT_GT(j, last);
      last = j;
      EXPECT_EQ(j > i, slot >= list.upperStart()[s]);
      if (overlaps(balls, i, j)) pairs.insert(std::minmax(i, j));
    }
  return pairs;
}

/// A list that has seen its balls at rest, and gives them room to move.
OverlapPairs roomyList(Balls balls) {
  OverlapPairs list;
  for (int motion = 0; motion < 3; ++motion) {
    list.update(balls.position, balls.radius);
    balls.position[0].x() += (motion < 2 ? 0.1 : -0.2) * OverlapPairs::kSkin * balls.radius[0];
  }
  return list;
}

/// Each pair has a number that its two rows know and no other pair has.
void expectNumbered(const OverlapPairs& list) {
  std::vector<std::pair<int, int>> ranks(list.slots() / 2, {-1, -1});
  for (int s = 0; s < list.size(); ++s)
    for (int slot = list.rowStart()[s]; slot < list.rowStart()[s + 1]; ++slot) {
      const int number = list.pair()[slot], t = list.candidate()[slot];
      ASSERT_TRUE(number >= 0 && number < static_cast<int>(ranks.size()));
      if (s > t) {
        EXPECT_EQ(ranks[number], std::pair(t, s));
        continue;
      }
      EXPECT_EQ(ranks[number], std::pair(-1, -1));
      EXPECT_TRUE(number >= list.firstPair()[s] && number < list.firstPair()[s + 1]);
      ranks[number] = {s, t};
    }
}

TEST(OverlapPairs, BothRowsKnowTheNumberOfAPair) {
  for (double clip : {1.0001, 4., 30.}) {
    const Balls balls = randomFoam(600, 1.2, clip, 0.9, 19);
    OverlapPairs list;
    list.update(balls.position, balls.radius);
    expectNumbered(list);
  }
}

TEST(OverlapPairs, BallsThatMayComeToLieInOthersAreNoted) {
  const Balls balls = randomFoam(600, 1.2, 30, 0.9, 23);
  OverlapPairs list;
  list.update(balls.position, balls.radius);
  const auto skin = OverlapPairs::kNoSkin;
  PairSet expected, noted;
  for (int i = 0; i < static_cast<int>(balls.size()); ++i)
    for (int j = 0; j < static_cast<int>(balls.size()); ++j) {
      const double own = balls.radius[i], other = balls.radius[j];
      const double spare = other - own + skin * (own + other);
      if (i != j && (balls.position[i] - balls.position[j]).norm() <= spare) expected.insert({i, j});
    }
  for (const auto& [inner, outer] : list.nestings()) noted.insert({list.order()[inner], list.order()[outer]});
  EXPECT_FALSE(expected.empty());
  EXPECT_EQ(noted, expected);
}

TEST(OverlapPairs, FindsWhatBruteForceFinds) {
  for (std::uint64_t seed = 0; seed < 4; ++seed)
    for (double clip : {1.0001, 4., 30.}) {
      const Balls balls = randomFoam(600, 1.2, clip, 0.9, seed);
      OverlapPairs list;
      EXPECT_TRUE(list.update(balls.position, balls.radius));
      EXPECT_EQ(listedOverlaps(balls, list), allOverlaps(balls)) << "seed " << seed << " clip " << clip;
    }
}

TEST(OverlapPairs, SmallOnesAroundABigOneAreFoundAtRatioThousand) {
  Balls balls;
  balls.add({0, 0, 0}, 1);
  for (int i = 0; i < 400; ++i) {
    CounterRandom random(3, static_cast<std::uint64_t>(i), 2);
    const Eigen::Vector3d direction(random.uniform() - .5, random.uniform() - .5, random.uniform() - .5);
    balls.add((1 + 0.002 * (random.uniform() - .5)) * direction.normalized(), 1e-3);
  }
  OverlapPairs list;
  list.update(balls.position, balls.radius);
  EXPECT_EQ(listedOverlaps(balls, list), allOverlaps(balls));
}

TEST(OverlapPairs, FarFromTheOriginNothingIsLost) {
  Balls balls = randomFoam(200, 0.5, 5, 0.9, 7);
  for (auto& x : balls.position) x += Eigen::Vector3d(-1e9, 3e8, 1e9);
  OverlapPairs list;
  list.update(balls.position, balls.radius);
  EXPECT_EQ(listedOverlaps(balls, list), allOverlaps(balls));
}

TEST(OverlapPairs, IsKeptWhileBubblesStayWithinTheSkinAndStillComplete) {
  Balls balls = randomFoam(500, 0.6, 5, 0.9, 11);
  OverlapPairs list = roomyList(balls);
  for (std::size_t i = 0; i < balls.size(); ++i) {
    CounterRandom random(5, i, 3);
    const Eigen::Vector3d direction(random.uniform() - .5, random.uniform() - .5, random.uniform() - .5);
    balls.position[i] += 0.9 * OverlapPairs::kSkin * balls.radius[i] * direction.normalized();
  }
  EXPECT_FALSE(list.update(balls.position, balls.radius));
  EXPECT_EQ(listedOverlaps(balls, list), allOverlaps(balls));
  balls.radius[17] *= 1.2;
  EXPECT_TRUE(list.update(balls.position, balls.radius));
  EXPECT_EQ(listedOverlaps(balls, list), allOverlaps(balls));
}

TEST(OverlapPairs, ACommonDriftKeepsTheList) {
  Balls balls = randomFoam(500, 0.6, 5, 0.9, 17);
  OverlapPairs list = roomyList(balls);
  for (auto& x : balls.position) x += Eigen::Vector3d(3, -40, 7);  // many radii
  EXPECT_FALSE(list.update(balls.position, balls.radius));
  EXPECT_EQ(listedOverlaps(balls, list), allOverlaps(balls));
  balls.position[3].x() += 2 * OverlapPairs::kSkin * balls.radius[3];
  EXPECT_TRUE(list.update(balls.position, balls.radius));
}

TEST(OverlapPairs, ThereIsRoomToMoveOnceBallsHaveMovedLittleTwice) {
  Balls balls = randomFoam(500, 0.6, 5, 0.9, 37);
  OverlapPairs list;
  const auto isRenewedAfter = [&](double radii) {
    balls.position[3].x() += radii * balls.radius[3];
    const bool renewed = list.update(balls.position, balls.radius);
    EXPECT_EQ(listedOverlaps(balls, list), allOverlaps(balls));
    return renewed;
  };
  EXPECT_TRUE(isRenewedAfter(0));
  const std::size_t tight = list.slots();
  EXPECT_FALSE(isRenewedAfter(0));
  EXPECT_TRUE(isRenewedAfter(0.03));
  EXPECT_TRUE(isRenewedAfter(0.03));
  EXPECT_GT(list.slots(), 1.2 * tight);
  EXPECT_FALSE(isRenewedAfter(0.03));
  EXPECT_TRUE(isRenewedAfter(2));
  EXPECT_LT(list.slots(), 1.1 * tight);
}

TEST(OverlapPairs, StrangersDoNotKnowEachOther) {
  const Balls balls = randomFoam(400, 0.9, 5, 0.9, 41);
  constexpr std::size_t kStrangers = 150;
  OverlapPairs list;
  list.update(balls.position, balls.radius, kStrangers);
  PairSet expected;
  for (const auto& [i, j] : allOverlaps(balls))
    if (i < static_cast<int>(balls.size() - kStrangers)) expected.insert({i, j});
  EXPECT_EQ(listedOverlaps(balls, list), expected);
  expectNumbered(list);
  EXPECT_TRUE(list.update(balls.position, balls.radius, 0));
  EXPECT_EQ(listedOverlaps(balls, list), allOverlaps(balls));
}

/// Many enough for rows to be filled in more than one part.
Balls ballsInSpaceOrder() {
  const Balls balls = randomFoam(5000, 0.5, 5, 0.9, 43);
  std::vector<std::int32_t> order;
  sortInSpace(balls.position, order);
  Balls sorted;
  for (const std::int32_t i : order) sorted.add(balls.position[i], balls.radius[i]);
  return sorted;
}

TEST(OverlapPairs, RanksAreInputIndicesWhereTheInputIsInSpaceOrder) {
  Balls balls = ballsInSpaceOrder();
  OverlapPairs list;
  for (const bool isInOrder : {true, false, true}) {
    list.update(balls.position, balls.radius);
    int same = 0;
    for (int i = 0; i < list.size(); ++i) same += list.order()[i] == i && list.rank()[i] == i;
    EXPECT_EQ(same == list.size(), isInOrder);
    EXPECT_EQ(listedOverlaps(balls, list), allOverlaps(balls));
    expectNumbered(list);
    if (!isInOrder) {
      balls = ballsInSpaceOrder();
      continue;
    }
    for (int i = 1; i < list.size() / 2; i += 2) {  // leaps from end to end
      std::swap(balls.position[i], balls.position[list.size() - 1 - i]);
      std::swap(balls.radius[i], balls.radius[list.size() - 1 - i]);
    }
  }
}

TEST(OverlapPairs, StrangersBehindBallsInSpaceOrderDoNotKnowEachOther) {
  Balls balls = ballsInSpaceOrder();
  const int known = static_cast<int>(balls.size());
  for (int i = 0; i < known; i += 5)
    balls.add(balls.position[i] + Eigen::Vector3d(0.5 * balls.radius[i], 0, 0), balls.radius[i]);
  OverlapPairs list;
  list.update(balls.position, balls.radius, balls.size() - known);
  EXPECT_EQ(list.order().back(), list.size() - 1);
  PairSet expected;
  for (const auto& [i, j] : allOverlaps(balls))
    if (i < known) expected.insert({i, j});
  EXPECT_EQ(listedOverlaps(balls, list), expected);
  expectNumbered(list);
}

TEST(OverlapPairs, ACopyGoesOnByItself) {
  const Balls balls = randomFoam(200, 0.6, 5, 0.9, 29), others = randomFoam(300, 0.6, 5, 0.9, 31);
  OverlapPairs list;
  list.update(balls.position, balls.radius);
  OverlapPairs copy = list;
  list.update(others.position, others.radius);
  EXPECT_FALSE(copy.update(balls.position, balls.radius));
  EXPECT_EQ(listedOverlaps(balls, copy), allOverlaps(balls));
  EXPECT_EQ(listedOverlaps(others, list), allOverlaps(others));
}

TEST(OverlapPairs, FollowsBirthsAndDeaths) {
  const Balls balls = randomFoam(50, 0.6, 5, 0.9, 13);
  OverlapPairs list;
  for (std::size_t count : {0u, 1u, 50u, 20u, 0u, 50u}) {
    Balls part = balls;
    part.position.resize(count), part.radius.resize(count), part.id.resize(count);
    list.update(part.position, part.radius);
    EXPECT_EQ(listedOverlaps(part, list), allOverlaps(part));
  }
}

}  // namespace
}  // namespace spume::foam::test
