#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

namespace spume::foam {

/// Sorts distinct numbers from `from` into `to`. Short lists are sorted by counting for each number those
/// below it, whole registers at a time and without a branch; long ones, where that would be quadratic, by
/// comparison. `from` may be permuted; its capacity grows to whole registers.
inline void sortShort(std::vector<std::int32_t>& from, std::vector<std::int32_t>& to) {
  constexpr std::size_t kBlock = 16, kLongest = 96;  // longer ones are slower to count, as measured
  using Block [[gnu::vector_size(kBlock * sizeof(std::int32_t))]] = std::int32_t;
  const std::size_t count = from.size();
  to.resize(count);
  if (count > kLongest) {
    std::copy(from.begin(), from.end(), to.begin());
    std::sort(to.begin(), to.end());
    return;
  }
  const std::size_t padded = (count + kBlock - 1) / kBlock * kBlock;
  from.resize(padded, std::numeric_limits<std::int32_t>::max());
  for (std::size_t block = 0; block < padded; block += kBlock) {
    Block values, below = {};
    __builtin_memcpy(&values, &from[block], sizeof values);
    for (std::size_t k = 0; k < count; ++k) below -= from[k] < values;
    for (std::size_t k = 0; k < std::min(kBlock, count - block); ++k) to[below[k]] = values[k];
  }
  from.resize(count);
}

}  // namespace spume::foam
