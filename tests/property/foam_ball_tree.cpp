#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "foam/ball_tree.h"
#include "foam/short_sort.h"
#include "tests/support/foam_balls.h"

namespace spume::foam::test {
namespace {

constexpr double kReach = 1.1;

std::vector<std::int32_t> nearByForce(const Balls& balls, std::int32_t i) {
  std::vector<std::int32_t> near;
  for (std::int32_t j = 0; j < static_cast<std::int32_t>(balls.size()); ++j)
    if (j != i &&
        (balls.position[i] - balls.position[j]).norm() < kReach * (balls.radius[i] + balls.radius[j]))
      near.push_back(j);
  return near;
}

/// Opens the clusters in the given order of visits, once each.
void expectAllFound(const Balls& balls, BallTree& tree, bool backwards) {
  tree.build(balls.position, balls.radius, kReach);
  ASSERT_EQ(static_cast<std::size_t>(tree.size()), balls.size());
  BallTree::Query query;
  for (std::int32_t visit = 0; visit < tree.clusters(); ++visit) {
    const std::int32_t cluster = backwards ? tree.clusters() - 1 - visit : visit;
    tree.openCluster(cluster, query);
    const std::int32_t end = std::min((cluster + 1) * BallTree::kFan, tree.size());
    for (std::int32_t s = cluster * BallTree::kFan; s < end; ++s) {
      tree.findNear(s, query);
      std::vector<std::int32_t> found(query.near.begin(),
                                      query.near.begin() + static_cast<std::ptrdiff_t>(query.found));
      std::sort(found.begin(), found.end());
      EXPECT_EQ(found, nearByForce(balls, tree.order()[s])) << balls.size() << " balls, place " << s;
    }
  }
}

TEST(BallTree, FindsWhatBruteForceFindsAtAnyNumberOfBalls) {
  BallTree tree;  // used again for all sizes, up and down
  for (int count : {0, 1, 7, 8, 9, 63, 64, 65, 511, 513, 1300, 30, 5})
    for (bool backwards : {false, true}) expectAllFound(randomFoam(count, .9, 20, .9, 3), tree, backwards);
}

TEST(BallTree, OneFarAwayAndManyInOnePlaceAreFound) {
  Balls balls = randomFoam(300, .5, 4, .9, 5);
  balls.position[17] = Eigen::Vector3d(1e12, -1e12, 1e12);
  for (int k = 0; k < 40; ++k) balls.add(balls.position[3], 1);
  BallTree tree;
  expectAllFound(balls, tree, false);
}

TEST(ShortSort, SortsListsOfAnyLength) {
  for (std::size_t count : {0u, 1u, 15u, 16u, 17u, 95u, 96u, 97u, 300u}) {
    std::vector<std::int32_t> expected(count), sorted;
    std::iota(expected.begin(), expected.end(), -20);
    std::vector<std::int32_t> shuffled = expected;
    for (std::size_t k = 1; k < count; ++k)
      std::swap(shuffled[k], shuffled[CounterRandom(1, k, 2).bits() % (k + 1)]);
    shuffled.push_back(-1000);  // behind the last: not to be sorted
    sortShort(shuffled, count, sorted);
    EXPECT_EQ(sorted, expected);
  }
}

}  // namespace
}  // namespace spume::foam::test
