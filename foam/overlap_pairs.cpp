#include "foam/overlap_pairs.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "foam/parallel.h"
#include "foam/short_sort.h"

namespace spume::foam {
namespace {

constexpr std::int32_t kClusterGrain = 16;  ///< clusters per parallel task
constexpr std::size_t kUsualRow = 16;       ///< candidates of a bubble in a dense foam

}  // namespace

bool OverlapPairs::update(const std::vector<Eigen::Vector3d>& position, const std::vector<double>& radius) {
  if (stillValid(position, radius)) return false;
  builtPosition_ = position;
  builtRadius_ = radius;
  tree_.build(position, radius, 1 + kSkin);
  rank_.resize(radius.size());
  forEachIndex(radius.size(), [&](std::size_t s) { rank_[order()[s]] = static_cast<std::int32_t>(s); });
  findRows();
  joinRows();
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

/// Each bubble finds its own row: each pair is tested twice, but no thread waits for another.
void OverlapPairs::findRows() {
  rowStart_.resize(static_cast<std::size_t>(size()) + 1),
      upperStart_.resize(static_cast<std::size_t>(size()));
  pieces_.resize(static_cast<std::size_t>(tree_.clusters() + kClusterGrain - 1) / kClusterGrain);
  for (Finder& finder : finders_) finder.candidates.clear(), finder.query.group = -1;
  tbb::parallel_for(std::size_t{0}, pieces_.size(), [&](std::size_t piece) {
    Finder& finder = finders_.local();
    finder.candidates.reserve(static_cast<std::size_t>(size()) *
                              kUsualRow);  // untouched memory costs nothing
    pieces_[piece] = {&finder, finder.candidates.size()};
    const auto first = static_cast<std::int32_t>(piece) * kClusterGrain;
    for (std::int32_t c = first; c < std::min(first + kClusterGrain, tree_.clusters()); ++c) {
      tree_.openCluster(c, finder.query);
      for (std::int32_t s = c * BallTree::kFan; s < std::min((c + 1) * BallTree::kFan, size()); ++s)
        findRow(s, finder);
    }
  });
}

void OverlapPairs::findRow(std::int32_t s, Finder& finder) {
  tree_.findNear(s, finder.query);
  sortShort(finder.query.near, finder.query.found, finder.sorted);
  for (const std::int32_t i : finder.sorted) finder.candidates.push_back(rank_[i]);
  const auto upper = std::lower_bound(finder.sorted.begin(), finder.sorted.end(), order()[s]);
  rowStart_[s + 1] = static_cast<std::int32_t>(finder.sorted.size());
  upperStart_[s] = static_cast<std::int32_t>(upper - finder.sorted.begin());
}

/// Puts the rows, found by several threads, one after the other.
void OverlapPairs::joinRows() {
  rowStart_[0] = 0;
  for (std::int32_t s = 0; s < size(); ++s) rowStart_[s + 1] += rowStart_[s], upperStart_[s] += rowStart_[s];
  candidate_.resize(static_cast<std::size_t>(rowStart_.back()) + kLanes);
  tbb::parallel_for(std::size_t{0}, pieces_.size(), [&](std::size_t piece) {
    const std::int32_t first = static_cast<std::int32_t>(piece) * kClusterGrain * BallTree::kFan;
    const std::int32_t last = std::min(first + kClusterGrain * BallTree::kFan, size());
    const auto from =
        pieces_[piece].finder->candidates.begin() + static_cast<std::ptrdiff_t>(pieces_[piece].begin);
    std::copy_n(from, rowStart_[last] - rowStart_[first], candidate_.begin() + rowStart_[first]);
  });
}

}  // namespace spume::foam
