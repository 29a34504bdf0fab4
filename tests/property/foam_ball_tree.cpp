#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "foam/ball_tree.h"
#include "foam/cell_hash.h"
#include "foam/hilbert_curve.h"
#include "foam/radix_sort.h"
#include "foam/short_sort.h"
#include "tests/support/foam_balls.h"

namespace spume::foam::test {
namespace {

constexpr double kReach = 1.1;

/// The places after s.
std::vector<std::int32_t> laterByForce(const Balls& balls, const BallTree& tree, std::int32_t s) {
  std::vector<std::int32_t> near;
  for (std::int32_t t = s + 1; t < tree.size(); ++t) {
    const std::int32_t i = tree.order()[s], j = tree.order()[t];
    if ((balls.position[i] - balls.position[j]).norm() < kReach * (balls.radius[i] + balls.radius[j]))
      near.push_back(t);
  }
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
      query.found = 0;
      query.found = 0;
      tree.findLater(s, query);
      const std::vector<std::int32_t> found(query.near.begin(),
                                            query.near.begin() + static_cast<std::ptrdiff_t>(query.found));
      EXPECT_EQ(found, laterByForce(balls, tree, s)) << balls.size() << " balls, place " << s;
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

TEST(HilbertCurve, CellsThatFollowEachOtherShareAFace) {
  constexpr int kLevels = 4, kSide = 1 << kLevels;
  std::vector<Eigen::Vector3i> along(kSide * kSide * kSide, Eigen::Vector3i::Constant(-1));
  for (int x = 0; x < kSide; ++x)
    for (int y = 0; y < kSide; ++y)
      for (int z = 0; z < kSide; ++z)
        along[hilbertPlace(spreadCellBits(x) | spreadCellBits(y) << 1 | spreadCellBits(z) << 2, kLevels)] = {
            x, y, z};
  for (std::size_t k = 1; k < along.size(); ++k)
    EXPECT_EQ((along[k] - along[k - 1]).lpNorm<1>(), 1) << "place " << k;
}

TEST(RadixSort, SortsByAsManyBitsAsAskedAndLeavesTies) {
  for (int bits : {0, 5, 11, 12, 57}) {
    constexpr std::size_t kCount = 3000;
    RawBuffer<SortKey> keys, spare;
    keys.resize(kCount), spare.resize(kCount);
    std::vector<std::pair<std::uint64_t, std::int32_t>> expected;
    for (std::size_t k = 0; k < kCount; ++k) {
      const std::uint64_t key = CounterRandom(7, k, 1).bits() & ((1ull << bits) - 1);
      keys[k] = {key, static_cast<std::int32_t>(k)};
      expected.push_back({key, static_cast<std::int32_t>(k)});
    }
    std::sort(expected.begin(), expected.end());
    radixSort(keys, spare, kCount, bits);
    for (std::size_t k = 0; k < kCount; ++k)
      EXPECT_EQ(std::pair(keys[k].key, keys[k].index), expected[k]) << bits << " bits";
  }
}

template <typename Integer>
void expectSorted(Integer step) {
  for (std::size_t count : {0u, 1u, 7u, 8u, 9u, 15u, 16u, 17u, 95u, 96u, 97u, 300u}) {
    std::vector<Integer> expected(count), sorted;
    for (std::size_t k = 0; k < count; ++k) expected[k] = step * (static_cast<Integer>(k) - 20);
    std::vector<Integer> shuffled = expected;
    for (std::size_t k = 1; k < count; ++k)
      std::swap(shuffled[k], shuffled[CounterRandom(1, k, 2).bits() % (k + 1)]);
    shuffled.push_back(-1000 * step);  // behind the last: not to be sorted
    sortShort(shuffled, count, sorted);
    EXPECT_EQ(sorted, expected);
  }
}

TEST(ShortSort, SortsListsOfAnyLength) {
  expectSorted<std::int32_t>(1);
  expectSorted<std::int64_t>(std::int64_t{1} << 40);
}

}  // namespace
}  // namespace spume::foam::test
