#include "foam/overlap_pairs.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "foam/pair_sweep.h"
#include "foam/parallel.h"
#include "foam/space_order.h"

namespace spume::foam {
namespace {

constexpr std::uint64_t kRankBits = 0xffffffff;  ///< of an entry; the others are the input index

}  // namespace

bool OverlapPairs::update(const std::vector<Eigen::Vector3d>& position, const std::vector<double>& radius) {
  if (stillValid(position, radius)) return false;
  builtPosition_ = position;
  builtRadius_ = radius;
  sortInSpace(position, order_);
  rank_.resize(order_.size());
  forEachIndex(order_.size(), [&](std::size_t s) { rank_[order_[s]] = static_cast<std::int32_t>(s); });
  fillRows(PairSweep(position, radius, 1 + kSkin).find());
  findMirrors();
  return true;
}

/// Motion common to all bubbles brings none nearer to another: it need not count.
bool OverlapPairs::stillValid(const std::vector<Eigen::Vector3d>& position,
                              const std::vector<double>& radius) const {
  const std::size_t n = radius.size();
  if (n != builtRadius_.size() || rowStart_.empty()) return false;
  if (n == 0) return true;
  const auto displacement = [&](std::size_t i) { return (position[i] - builtPosition_[i]).eval(); };
  const auto allStayClose = [&](const Eigen::Vector3d& drift) {
    const auto staysClose = [&](std::size_t i) {
      const double moved = (displacement(i) - drift).norm() + std::abs(radius[i] - builtRadius_[i]);
      return moved <= kSkin * builtRadius_[i];
    };
    return reduceIndices(n, true, staysClose, std::logical_and<>());
  };
  const auto add = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return (a + b).eval(); };
  if (allStayClose(Eigen::Vector3d::Zero())) return true;
  return allStayClose(reduceIndices(n, Eigen::Vector3d::Zero().eval(), displacement, add) /
                      static_cast<double>(n));
}

/// Turns the pairs, each found once, into rows that hold each twice, sorted by input index. One thread deals
/// them out: several would fight over the ends of the rows.
void OverlapPairs::fillRows(const std::vector<PairSweep::Pairs>& found) {
  const std::size_t n = order_.size();
  rowStart_.assign(n + 1, 0);
  for (const auto& pairs : found)
    for (const auto& [i, j] : pairs) ++rowStart_[rank_[i] + 1], ++rowStart_[rank_[j] + 1];
  for (std::size_t s = 0; s < n; ++s) rowStart_[s + 1] += rowStart_[s];
  next_.assign(rowStart_.begin(), rowStart_.end() - 1);
  entry_.resize(rowStart_.back()), candidate_.resize(rowStart_.back());
  const auto entryOf = [&](std::int32_t i) {
    return static_cast<std::uint64_t>(i) << 32 | static_cast<std::uint32_t>(rank_[i]);
  };
  for (const auto& pairs : found)
    for (const auto& [i, j] : pairs) {
      const std::uint64_t forI = entryOf(j), forJ = entryOf(i);
      entry_[next_[forJ & kRankBits]++] = forI, entry_[next_[forI & kRankBits]++] = forJ;
    }
  forEachIndex(n, [&](std::size_t s) {
    std::sort(entry_.begin() + rowStart_[s], entry_.begin() + rowStart_[s + 1]);
    for (std::int32_t slot = rowStart_[s]; slot < rowStart_[s + 1]; ++slot)
      candidate_[slot] = static_cast<std::int32_t>(entry_[slot] & kRankBits);
  });
}

/// Bubbles in input order meet each row's slots in their order.
void OverlapPairs::findMirrors() {
  mirror_.resize(candidate_.size());
  next_.assign(rowStart_.begin(), rowStart_.end() - 1);
  for (const std::int32_t s : rank_)
    for (std::int32_t slot = rowStart_[s]; slot < rowStart_[s + 1]; ++slot)
      mirror_[slot] = next_[candidate_[slot]]++;
}

}  // namespace spume::foam
