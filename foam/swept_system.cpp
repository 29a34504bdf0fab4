#include "foam/swept_system.h"

#include <array>
#include <numeric>

#include "foam/parallel.h"

namespace spume::foam {

void SweptSystem::copy(const BlockSystem& a, bool sweeps) {
  const std::size_t n = a.size();
  order = a.order;
  if (order.empty()) {
    order.resize(n);
    std::iota(order.begin(), order.end(), 0);
  }
  rank_.resize(n), row.resize(n), diagonal.resize(n);
  other.resize(a.other.size()), coupling.resize(a.other.size());
  forEachIndex(n, [&](std::size_t k) { rank_[order[k]] = static_cast<std::int32_t>(k); });
  std::int32_t entry = 0;
  for (std::size_t k = 0; k < n; ++k) {
    row[k].start = entry;
    entry += a.start[order[k] + 1] - a.start[order[k]];
    row[k].end = entry;
  }
  forEachIndex(n, [&](std::size_t k) { copyRow(a, k, sweeps); });
}

/// Places the couplings by three visits, so that each kind stays in the order of the BlockSystem.
void SweptSystem::copyRow(const BlockSystem& a, std::size_t k, bool sweeps) {
  const std::int32_t i = order[k];
  const auto kindOf = [&](std::int32_t t) {
    const auto s = static_cast<std::size_t>(t);
    if (!sweeps || s / kBlockRows != k / kBlockRows) return 2;
    return s < k ? 0 : 1;
  };
  std::array<std::int32_t, 3> place{};
  for (std::int32_t e = a.start[i]; e < a.start[i + 1]; ++e) {
    const int kind = kindOf(rank_[a.other[e]]);
    for (int later = kind + 1; later < 3; ++later) ++place[later];
  }
  for (std::int32_t& at : place) at += row[k].start;
  row[k].after = place[1], row[k].beyond = place[2];
  for (std::int32_t e = a.start[i]; e < a.start[i + 1]; ++e) {
    const std::int32_t t = rank_[a.other[e]], to = place[kindOf(t)]++;
    const CouplingBlock& block = a.block[e];
    other[to] = t;
    coupling[to] << block.along.cast<float>(), static_cast<float>(block.across);
  }
}

void SweptSystem::copyDiagonals(const BlockSystem& a) {
  forEachIndex(size(), [&](std::size_t k) {
    Eigen::Matrix3d sum = a.own[order[k]];
    for (std::int32_t e = row[k].start; e < row[k].end; ++e) sum += matrixOf(coupling[e]);
    diagonal[k] = SymmetricBlock(sum);
  });
}

}  // namespace spume::foam
