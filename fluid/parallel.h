#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <Eigen/Core>

namespace spume::fluid {

/// Calls body(i, j) for every row (fixed i, j; k runs inside the body) of a window of `size` points, in
/// parallel.
template <typename Body>
void forEachRow(const Eigen::Vector3i& size, const Body& body) {
  tbb::parallel_for(tbb::blocked_range<int>(0, size.x()), [&](const tbb::blocked_range<int>& range) {
    for (int i = range.begin(); i < range.end(); ++i)
      for (int j = 0; j < size.y(); ++j) body(i, j);
  });
}

/// Calls body(i, j, k) for every point of a window of `size` points, in parallel over i.
template <typename Body>
void forEachCell(const Eigen::Vector3i& size, const Body& body) {
  forEachRow(size, [&](int i, int j) {
    for (int k = 0; k < size.z(); ++k) body(i, j, k);
  });
}

/// Sum over i-slabs that does not depend on the number of threads: `slab(i)` returns the partial of slab i.
template <typename Value, typename Slab, typename Join>
Value reduceSlabs(int slabs, Value identity, const Slab& slab, const Join& join) {
  return tbb::parallel_deterministic_reduce(
      tbb::blocked_range<int>(0, slabs, 1), identity,
      [&](const tbb::blocked_range<int>& range, Value sum) {
        for (int i = range.begin(); i < range.end(); ++i) sum = join(sum, slab(i));
        return sum;
      },
      join, tbb::simple_partitioner());
}

}  // namespace spume::fluid
