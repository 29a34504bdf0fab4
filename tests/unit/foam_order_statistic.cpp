// Values at given places among others, against sorting them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "foam/counter_random.h"
#include "foam/order_statistic.h"

namespace spume::foam::test {
namespace {

/// Over many octaves, with zeros, the largest number and many that are the same.
std::vector<double> values(std::size_t n) {
  std::vector<double> values(n);
  for (std::size_t i = 0; i < n; ++i) {
    CounterRandom random(1, i, 2);
    const double x = random.uniform();
    values[i] = x < 0.1   ? 0
                : x > 0.9 ? std::numeric_limits<double>::max()
                          : std::exp(40 * random.uniform() - 20);
    if (x > 0.4 && x < 0.5) values[i] = 0.7;
  }
  return values;
}

TEST(OrderStatistic, IsThatOfTheSortedValues) {
  for (const std::size_t n : {1u, 2u, 1024u, 30000u}) {
    const std::vector<double> unsorted = values(n);
    std::vector<double> sorted = unsorted;
    std::sort(sorted.begin(), sorted.end());
    for (const double share : {0.0, 0.05, 0.3, 0.55, 0.85, 0.999999}) {
      const auto k = static_cast<std::size_t>(share * static_cast<double>(n));
      EXPECT_EQ(orderStatistic(unsorted, k), sorted[k]) << n << " " << k;
    }
  }
}

}  // namespace
}  // namespace spume::foam::test
