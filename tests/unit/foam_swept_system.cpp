// How a system is laid out for sweeps: nothing of it is lost, and each sweep finds what it needs.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "foam/counter_random.h"
#include "foam/neighbours.h"
#include "foam/swept_system.h"

namespace spume::foam {
namespace {

/// Rows in a line, each linked to a few that follow it within 40: many in the first third, none in the
/// second, so that blocks of equal work are of unequal length.
BlockSystem unevenSystem(int n) {
  std::vector<OverlapPair> pairs;
  for (int i = 0; i < n; ++i) {
    const int links = i < n / 3 ? 8 : i < 2 * n / 3 ? 0 : 2;
    for (int k = 0; k < links; ++k)
      if (const int j = i + 1 + 5 * k; j < n) pairs.push_back({i, j, 1.0, -1});
  }
  Neighbours neighbours;
  neighbours.build(static_cast<std::size_t>(n), pairs);
  BlockSystem a;
  a.start = neighbours.start, a.other = neighbours.other;
  for (const std::int32_t pair : neighbours.pair) {
    CounterRandom random(5, static_cast<std::uint64_t>(pair), 0);
    const double x = random.uniform(), y = random.uniform(), z = random.uniform();
    a.block.push_back({Eigen::Vector3d(x, y, z), random.uniform()});
  }
  a.own.assign(static_cast<std::size_t>(n), Eigen::Matrix3d::Identity());
  return a;
}

struct SweptSystemOf : testing::TestWithParam<int> {
  const BlockSystem system = unevenSystem(GetParam());
  SweptSystem swept;
};

TEST_P(SweptSystemOf, HasEachRowOnceAndItsDiagonal) {
  swept.copy(system, true);
  std::vector<std::int32_t> rows = swept.source, all(system.size());
  std::sort(rows.begin(), rows.end());
  std::iota(all.begin(), all.end(), 0);
  EXPECT_EQ(rows, all);
  EXPECT_EQ(swept.groupStart().back(), system.size());
  constexpr double kSingle = 1e-6;  // couplings are kept in single precision, some twenty add up
  for (std::size_t k = 0; k < swept.size(); ++k) {
    const Eigen::Matrix3d exact = system.diagonal(static_cast<std::size_t>(swept.source[k]));
    EXPECT_LE((swept.diagonal[k] - exact).norm(), kSingle * exact.norm());
  }
}

TEST_P(SweptSystemOf, SweepsMeetWhatTheyMayKnow) {
  swept.copy(system, true);
  const auto n = static_cast<std::int32_t>(system.size());
  const auto groupOf = [&](std::int32_t row) {
    const auto& start = swept.groupStart();
    return std::upper_bound(start.begin(), start.end(), static_cast<std::size_t>(row)) - start.begin();
  };
  const auto isBorder = [&](std::int32_t row) {
    return groupOf(row) > static_cast<std::ptrdiff_t>(swept.tasks());
  };
  const auto mayFollow = [&](std::int32_t row, std::int32_t later) {
    return later > row && (groupOf(later) == groupOf(row) || (isBorder(later) && !isBorder(row)));
  };
  std::map<std::pair<std::int32_t, std::int32_t>, int> met;
  int behind = 0;
  for (std::int32_t k = 0; k < n; ++k) {
    const SweptSystem::Row &row = swept.row[k], &next = swept.row[k + 1];
    for (std::int32_t e = row.ahead; e < next.ahead; ++e) {
      const std::int32_t other = swept.ahead.other[e];
      EXPECT_TRUE(mayFollow(k, other)) << "row " << k;
      ++met[{k, other}];
    }
    for (std::int32_t e = row.behind; e < next.behind; ++e) {
      const bool isBehind = e < row.beyond;
      const std::int32_t other = swept.known.other[e] - (isBehind ? n + 1 : 0);
      EXPECT_TRUE(isBehind ? mayFollow(other, k) : isBorder(k) && isBorder(other)) << "row " << k;
      behind += isBehind;
      ++met[{k, other}];
    }
  }
  std::size_t missing = 0;
  std::vector<std::int32_t> place(system.size());
  for (std::int32_t k = 0; k < n; ++k) place[swept.source[k]] = k;
  for (std::int32_t i = 0; i < n; ++i)
    for (std::int32_t e = system.start[i]; e < system.start[i + 1]; ++e)
      missing += met[{place[i], place[system.other[e]]}] != 1;
  EXPECT_EQ(missing, 0u);
  EXPECT_EQ(met.size(), system.other.size());
  EXPECT_GE(behind, static_cast<int>(0.49 * static_cast<double>(system.other.size())));  // few are cut
}

TEST_P(SweptSystemOf, BlocksOfAGroupEndTogether) {
  constexpr std::ptrdiff_t kTail = 64;
  swept.copy(system, true);
  for (std::size_t group = 0; group < swept.groups(); ++group) {
    const auto begin = swept.source.begin() + static_cast<std::ptrdiff_t>(swept.groupStart()[group]);
    const auto end = swept.source.begin() + static_cast<std::ptrdiff_t>(swept.groupStart()[group + 1]);
    if (end - begin <= kTail || std::is_sorted(begin, end)) continue;  // one block alone
    EXPECT_FALSE(std::is_sorted(end - kTail, end)) << "one block is left over, group " << group;
  }
}

TEST_P(SweptSystemOf, SumsOfSweepsAreThoseOfTheirRows) {
  swept.copy(system, true);
  std::vector<double> expected(swept.groups());
  for (std::size_t g = 0; g < swept.groups(); ++g)
    for (std::size_t k = swept.groupStart()[g]; k < swept.groupStart()[g + 1]; ++k)
      expected[g] += static_cast<double>(k % 7);  // few digits: exact in any order
  const auto add = [](std::size_t k, DoubleQuad* of) {
    const auto one = static_cast<float>(k % 7);
    addTo(of[0], Quad{one, 0, 0, 9}), addTo(of[1], Quad{0, one, one, 9});
  };
  std::vector<GroupSums> forth, back;
  Crew::lead(swept.tasks(), [&](Crew& crew) {
    const auto addForth = [&](std::size_t, std::size_t k, DoubleQuad* of) { add(k, of); };
    sumForth<2>(crew, swept, forth, addForth), sumBack<2>(crew, swept, back, add);
  });
  for (std::size_t g = 0; g < swept.groups(); ++g)
    for (const GroupSums& sums : {forth[g], back[g]}) {
      EXPECT_EQ(sums.of[0], expected[g]);
      EXPECT_EQ(sums.of[1], 2 * expected[g]);
    }
}

INSTANTIATE_TEST_SUITE_P(Rows, SweptSystemOf, testing::Values(1, 700, 2100, 9000));

}  // namespace
}  // namespace spume::foam
