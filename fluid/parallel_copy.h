#pragma once

#include <algorithm>
#include <cstddef>

#include "fluid/dense_field.h"
#include "fluid/parallel.h"

namespace spume::fluid {

/// Values copied by one task.
inline constexpr std::size_t kCopyGrain = std::size_t{1} << 16;

/// Copies `count` values in parallel: one thread alone does not use all of the memory's speed.
template <typename T>
void copyInParallel(const T* from, std::size_t count, T* to) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, kCopyGrain), [&](const auto& range) {
    std::copy(from + range.begin(), from + range.end(), to + range.begin());
  });
}

template <typename T>
void copyInParallel(const DenseField<T>& from, DenseField<T>& to) {
  if (to.size() != from.size())
    to = from;
  else
    copyInParallel(from.data(), static_cast<std::size_t>(from.count()), to.data());
}

template <typename T>
void copyInParallel(const MacField<T>& from, MacField<T>& to) {
  for (int a = 0; a < 3; ++a) copyInParallel(from[a], to[a]);
}

}  // namespace spume::fluid
