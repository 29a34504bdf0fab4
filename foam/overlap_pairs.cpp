#include "foam/overlap_pairs.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>

#include "foam/parallel.h"
#include "foam/short_sort.h"

namespace spume::foam {
namespace {

constexpr std::int32_t kClusterGrain = 16;  ///< clusters per parallel task
constexpr std::size_t kUsualRow = 16;       ///< candidates of a bubble in a dense foam

constexpr std::size_t kSearched = 4 * kLanes;  ///< at once: few rows are longer

/// The first place of a value in a list that holds it and is padded by as many as are searched at once.
const std::int32_t* findIn(const std::int32_t* list, std::int32_t value) {
  for (;; list += kSearched) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < kSearched; k += kLanes) bits |= equalBits(list + k, value) << k;
    if (bits != 0) return list + std::countr_zero(bits);
  }
}

}  // namespace

bool OverlapPairs::update(const std::vector<Eigen::Vector3d>& position, const std::vector<double>& radius,
                          std::size_t strangers) {
  ++uses_;
  if (strangers == strangers_ && holdsWith(skin_, position, radius)) return false;
  chooseSkin(position, radius);
  strangers_ = strangers;
  builtPosition_ = position;
  builtRadius_ = radius;
  tree_.build(position, radius, 1 + skin_);
  rank_.resize(radius.size());
  forEachIndex(radius.size(), [&](std::size_t s) { rank_[order()[s]] = static_cast<std::int32_t>(s); });
  findRows();
  joinRows();
  numberPairs();
  return true;
}

/// Before a list is replaced. It has been asked for once in vain beside the times it was used.
void OverlapPairs::chooseSkin(const std::vector<Eigen::Vector3d>& position,
                              const std::vector<double>& radius) {
  const bool before = movedLittle_;
  movedLittle_ = uses_ > 3 || (skin_ < kSkin && holdsWith(kSkin, position, radius));
  skin_ = before && movedLittle_ ? kSkin : kNoSkin;
  uses_ = 1;
}

/// Motion common to all bubbles brings none nearer to another: it need not count.
bool OverlapPairs::holdsWith(double skin, const std::vector<Eigen::Vector3d>& position,
                             const std::vector<double>& radius) const {
  const std::size_t n = radius.size();
  if (n != builtRadius_.size() || rowStart_.empty()) return false;
  if (n == 0) return true;
  const auto displacement = [&](std::size_t i) { return (position[i] - builtPosition_[i]).eval(); };
  const auto allStayClose = [&](const Eigen::Vector3d& drift) {
    const auto staysClose = [&](std::size_t i) {
      const double moved = (displacement(i) - drift).norm() + std::abs(radius[i] - builtRadius_[i]);
      return moved <= skin * builtRadius_[i];
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
  rowStart_.resize(static_cast<std::size_t>(size()) + 1), firstPair_.resize(rowStart_.size());
  upperStart_.resize(static_cast<std::size_t>(size()));
  pieces_.resize(static_cast<std::size_t>(tree_.clusters() + kClusterGrain - 1) / kClusterGrain);
  for (Finder& finder : finders_) finder.candidates.clear(), finder.nestings.clear(), finder.query.group = -1;
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
  const auto firstFrom = [&](std::int32_t index) {
    return std::lower_bound(finder.sorted.begin(), finder.sorted.end(), index);
  };
  if (const std::int32_t known = size() - static_cast<std::int32_t>(strangers_); order()[s] >= known)
    finder.sorted.erase(firstFrom(known), finder.sorted.end());
  const auto upper = firstFrom(order()[s]);
  rowStart_[s + 1] = static_cast<std::int32_t>(finder.sorted.size());
  upperStart_[s] = static_cast<std::int32_t>(upper - finder.sorted.begin());
  firstPair_[s + 1] = 0;
  for (std::int32_t& candidate : finder.sorted)
    candidate = rank_[candidate], firstPair_[s + 1] += candidate > s;
  finder.candidates.insert(finder.candidates.end(), finder.sorted.begin(), finder.sorted.end());
  for (const std::int32_t holder : finder.query.holders) finder.nestings.push_back({s, holder});
}

/// Puts the rows, found by several threads, one after the other.
void OverlapPairs::joinRows() {
  rowStart_[0] = firstPair_[0] = 0;
  for (std::int32_t s = 0; s < size(); ++s) {
    firstPair_[s + 1] += firstPair_[s];
    rowStart_[s + 1] += rowStart_[s], upperStart_[s] += rowStart_[s];
  }
  candidate_.resize(slots() + kSearched), pair_.resize(slots() + kLanes);
  std::fill_n(pair_.data() + slots(), kLanes, 0);  // whole registers read on behind the last row
  tbb::parallel_for(std::size_t{0}, pieces_.size(), [&](std::size_t piece) {
    const std::int32_t first = static_cast<std::int32_t>(piece) * kClusterGrain * BallTree::kFan;
    const std::int32_t last = std::min(first + kClusterGrain * BallTree::kFan, size());
    const auto from =
        pieces_[piece].finder->candidates.begin() + static_cast<std::ptrdiff_t>(pieces_[piece].begin);
    std::copy_n(from, rowStart_[last] - rowStart_[first], candidate_.data() + rowStart_[first]);
  });
  nestings_.clear();
  for (const Finder& finder : finders_)
    nestings_.insert(nestings_.end(), finder.nestings.begin(), finder.nestings.end());
}

/// Numbers the pairs along the rows of their bubbles of lower rank, and tells the others.
void OverlapPairs::numberPairs() {
  forEachIndex(static_cast<std::size_t>(size()), [&](std::size_t place) {
    const auto s = static_cast<std::int32_t>(place);
    std::int32_t number = firstPair_[s];
    for (std::int32_t slot = rowStart_[s]; slot < rowStart_[s + 1]; ++slot) {
      const std::int32_t t = candidate_[slot];
      if (t < s) continue;
      pair_[slot] = pair_[findIn(&candidate_[rowStart_[t]], s) - candidate_.data()] = number++;
    }
  });
}

}  // namespace spume::foam
