#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

namespace spume::foam {

/// Sorts distinct numbers from `from` into `to`. Short lists are sorted by counting for each number those
/// below it, whole registers at a time and without a branch; long ones, where that would be quadratic, by
/// comparison. Sorts the first `count` of `from`, which has room for whole registers and loses what lies
/// behind them.
template <typename Integer>
void sortShort(std::vector<Integer>& from, std::size_t count, std::vector<Integer>& to) {
  constexpr std::size_t kBlock = 64 / sizeof(Integer),
                        kLongest = 96;  // longer ones are slower to count, as measured
  using Block [[gnu::vector_size(64)]] = Integer;
  to.resize(count);
  if (count > kLongest) {
    std::copy_n(from.begin(), count, to.begin());
    std::sort(to.begin(), to.end());
    return;
  }
  const std::size_t padded = (count + kBlock - 1) / kBlock * kBlock;
  if (from.size() < padded) from.resize(padded);
  std::fill(from.begin() + static_cast<std::ptrdiff_t>(count),
            from.begin() + static_cast<std::ptrdiff_t>(padded), std::numeric_limits<Integer>::max());
  for (std::size_t block = 0; block < padded; block += kBlock) {
    Block values, below = {};
    __builtin_memcpy(&values, &from[block], sizeof values);
    for (std::size_t k = 0; k < count; ++k) below -= from[k] < values;
    for (std::size_t k = 0; k < std::min(kBlock, count - block); ++k) to[below[k]] = values[k];
  }
}

}  // namespace spume::foam
