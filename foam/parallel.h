#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <cstddef>

namespace spume::foam {

/// Items a task takes at least: below it a task costs more than its work.
inline constexpr std::size_t kGrain = 1024;

/// Calls body(i) for i in [0, n), in parallel when n is worth it.
template <typename Body>
void forEachIndex(std::size_t n, const Body& body) {
  if (n <= kGrain) {
    for (std::size_t i = 0; i < n; ++i) body(i);
    return;
  }
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, n, kGrain), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) body(i);
  });
}

/// Calls body(begin, end) for blocks of [0, n) that together are all of it, in parallel.
template <typename Body>
void forEachBlock(std::size_t n, const Body& body) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, n, kGrain),
                    [&](const auto& range) { body(range.begin(), range.end()); });
}

/// Joins value(i) over [0, n) in a tree that depends on n alone, so the bits do not depend on the threads.
template <typename Value, typename Item, typename Join>
Value reduceIndices(std::size_t n, const Value& identity, const Item& value, const Join& join) {
  const auto fold = [&](const tbb::blocked_range<std::size_t>& range, Value sum) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) sum = join(sum, value(i));
    return sum;
  };
  const tbb::blocked_range<std::size_t> all(0, n, kGrain);
  if (n <= kGrain) return fold(all, identity);
  return tbb::parallel_deterministic_reduce(all, identity, fold, join, tbb::simple_partitioner());
}

}  // namespace spume::foam
