#pragma once

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "foam/parallel.h"

namespace spume::foam {

/// The value that would be at place k, from 0, if all were sorted; none may be negative or NaN, and k must be
/// below their number. Threads count them by their leading bits, which order them; only those that share the
/// wanted one's are looked at again. O(n).
inline double orderStatistic(const std::vector<double>& values, std::size_t k) {
  constexpr int kBits = 16;  // sign, exponent and four of the mantissa: a sixteenth of an octave
  assert(k < values.size());
  const auto binOf = [](double value) { return std::bit_cast<std::uint64_t>(value + 0.0) >> (64 - kBits); };
  using Counts = std::vector<std::uint32_t>;
  tbb::enumerable_thread_specific<Counts> counts(std::size_t{1} << kBits);
  const std::size_t blocks = values.size() / kGrain + 1;
  tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t block) {
    Counts& own = counts.local();
    for (std::size_t i = block * kGrain; i < std::min(values.size(), (block + 1) * kGrain); ++i)
      ++own[binOf(values[i])];
  });
  std::size_t bin = 0;
  for (std::size_t before = k;; ++bin) {
    std::size_t here = 0;
    for (const Counts& own : counts) here += own[bin];
    if (before < here) {
      k = before;
      break;
    }
    before -= here;
  }
  std::vector<double> left;
  for (const double value : values)
    if (binOf(value) == bin) left.push_back(value);
  std::nth_element(left.begin(), left.begin() + static_cast<std::ptrdiff_t>(k), left.end());
  return left[k];
}

}  // namespace spume::foam
