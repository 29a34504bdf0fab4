// Indices listed in parallel, against a loop over all.
#include <gtest/gtest.h>

#include <cstdint>

#include "foam/index_list.h"

namespace spume::foam::test {
namespace {

TEST(IndexList, HasTheChosenInTheirOrder) {
  const auto isChosen = [](std::size_t i) { return i * i % 7 == 2 || i / 1500 == 3; };
  for (const std::size_t n : {0u, 1u, 5u, 1024u, 1025u, 20000u}) {
    std::vector<std::int32_t> list = {-1, -1}, expected;
    listIndices(n, isChosen, list);
    for (std::size_t i = 0; i < n; ++i)
      if (isChosen(i)) expected.push_back(static_cast<std::int32_t>(i));
    EXPECT_EQ(list, expected) << n;
  }
}

}  // namespace
}  // namespace spume::foam::test
