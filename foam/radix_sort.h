#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "foam/raw_buffer.h"

namespace spume::foam {

/// An index and what it is sorted by.
struct SortKey {
  std::uint64_t key;
  std::int32_t index;
};

/// Sorts by the lowest `bits` bits of the keys, ties in the order they came: by digits from the last one, in
/// time that grows with `bits` and not with the logarithm of `count`. `spare`: of the same size.
inline void radixSort(RawBuffer<SortKey>& keys, RawBuffer<SortKey>& spare, std::size_t count, int bits) {
  constexpr int kDigit = 11;  // as many streams as the nearest cache has lines, or few more
  for (int shift = 0; shift < bits; shift += kDigit) {
    const auto digitOf = [&](const SortKey& item) { return item.key >> shift & ((1u << kDigit) - 1); };
    std::array<std::size_t, std::size_t{1} << kDigit> begin{};
    for (std::size_t k = 0; k < count; ++k) ++begin[digitOf(keys[k])];
    std::size_t sum = 0;
    for (std::size_t& place : begin) sum += std::exchange(place, sum);
    for (std::size_t k = 0; k < count; ++k) spare[begin[digitOf(keys[k])]++] = keys[k];
    std::swap(keys, spare);
  }
}

}  // namespace spume::foam
