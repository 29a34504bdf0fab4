#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <vector>

#include "foam/parallel.h"

namespace spume::foam {

/// Rows of what is paired with each item, built in parallel from pairs that come in any order. An entry is a
/// sort key above a 32-bit value; rows are sorted, so the result does not depend on the order or the threads.
struct PairRows {
  std::vector<std::int32_t> start;  ///< n + 1; entries of row s are start[s] .. start[s + 1] - 1
  std::vector<std::uint64_t> entry;

  static std::uint64_t pack(std::int32_t key, std::int32_t value) {
    return static_cast<std::uint64_t>(key) << 32 | static_cast<std::uint32_t>(value);
  }
  static std::int32_t keyOf(std::uint64_t entry) { return static_cast<std::int32_t>(entry >> 32); }
  static std::int32_t valueOf(std::uint64_t entry) { return static_cast<std::int32_t>(entry & 0xffffffff); }

  /// `visitPairs(body)` calls body(s, t, entry for row s, entry for row t) for each pair, in parallel if it
  /// likes.
  template <typename VisitPairs>
  void build(std::size_t rows, const VisitPairs& visitPairs) {
    const auto claim = [](std::int32_t& counter) {
      return std::atomic_ref(counter).fetch_add(1, std::memory_order_relaxed);
    };
    start.assign(rows + 1, 0);
    visitPairs([&](std::int32_t s, std::int32_t t, std::uint64_t, std::uint64_t) {
      claim(start[s + 1]), claim(start[t + 1]);
    });
    for (std::size_t s = 0; s < rows; ++s) start[s + 1] += start[s];
    next_.assign(start.begin(), start.end() - 1);
    entry.resize(start.back());
    visitPairs([&](std::int32_t s, std::int32_t t, std::uint64_t forS, std::uint64_t forT) {
      entry[claim(next_[s])] = forS, entry[claim(next_[t])] = forT;
    });
    forEachIndex(rows,
                 [&](std::size_t s) { std::sort(entry.begin() + start[s], entry.begin() + start[s + 1]); });
  }

 private:
  std::vector<std::int32_t> next_;
};

}  // namespace spume::foam
