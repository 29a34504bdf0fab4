#pragma once

#include <algorithm>
#include <cmath>

#include "fluid/parallel.h"
#include "fluid/pressure_system.h"

namespace spume::fluid {

/// Calls body(row) for every active row, in parallel; few rows stay on the calling thread.
template <typename Body>
void forEachActiveRow(const std::vector<ActiveRow>& rows, const Body& body) {
  const int count = static_cast<int>(rows.size());
  if (count <= 2 * kRowChunk) {
    for (const ActiveRow& row : rows) body(row);
    return;
  }
  tbb::parallel_for(tbb::blocked_range<int>(0, count, kRowChunk), [&](const tbb::blocked_range<int>& range) {
    for (int n = range.begin(); n < range.end(); ++n) body(rows[n]);
  });
}

/// Joins `body(row)` over all active rows in an order that does not depend on the number of threads.
template <typename Body, typename Join>
double reduceActiveRows(const std::vector<ActiveRow>& rows, const Body& body, const Join& join) {
  const int count = static_cast<int>(rows.size());
  return reduceSlabs(
      chunkCount(rows), 0.0,
      [&](int chunk) {
        double value = 0;
        const int end = std::min(count, (chunk + 1) * kRowChunk);
        for (int n = chunk * kRowChunk; n < end; ++n) value = join(value, body(rows[n]));
        return value;
      },
      join);
}

/// Independent partial sums of a loop over a row, so that it vectorises without reordering anybody's
/// additions.
inline constexpr int kLanes = 16;

template <typename B>
double dotProduct(const double* __restrict a, const B* __restrict b, int count) {
  double lane[kLanes] = {};
  int k = 0;
  for (; k + kLanes <= count; k += kLanes)
    for (int l = 0; l < kLanes; ++l) lane[l] += a[k + l] * b[k + l];
  for (; k < count; ++k) lane[0] += a[k] * b[k];
  double sum = 0;
  for (double value : lane) sum += value;
  return sum;
}

inline double maxMagnitude(const double* a, int count) {
  double lane[kLanes] = {};
  int k = 0;
  for (; k + kLanes <= count; k += kLanes)
    for (int l = 0; l < kLanes; ++l) {
      const double value = std::abs(a[k + l]);
      lane[l] = value > lane[l] ? value : lane[l];
    }
  for (; k < count; ++k) lane[0] = std::max(lane[0], std::abs(a[k]));
  return *std::max_element(lane, lane + kLanes);
}

}  // namespace spume::fluid
