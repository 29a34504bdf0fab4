#include "foam/overlap_pairs.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "foam/parallel.h"

namespace spume::foam {
namespace {

constexpr std::int32_t kClusterGrain = 16;   ///< clusters per parallel task
constexpr std::int32_t kNumberGrain = 4096;  ///< bubbles per task: most pairs are of two of the same

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
  if (!tree_.isInputOrder()) sortRows();
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
  for (Finder& finder : finders_) finder.query.found = 0, finder.query.group = -1, finder.nestings.clear();
  tbb::parallel_for(std::size_t{0}, pieces_.size(), [&](std::size_t piece) {
    Finder& finder = finders_.local();
    pieces_[piece] = {&finder, finder.query.found};
    const auto first = static_cast<std::int32_t>(piece) * kClusterGrain;
    for (std::int32_t c = first; c < std::min(first + kClusterGrain, tree_.clusters()); ++c) {
      tree_.openCluster(c, finder.query);
      for (std::int32_t s = c * BallTree::kFan; s < std::min((c + 1) * BallTree::kFan, size()); ++s)
        findRow(s, finder);
    }
  });
}

void OverlapPairs::findRow(std::int32_t s, Finder& finder) {
  BallTree::Query& query = finder.query;
  const std::size_t begin = query.found;
  tree_.findNear(s, query);
  const auto row = query.near.begin() + static_cast<std::ptrdiff_t>(begin);
  if (const std::int32_t known = size() - static_cast<std::int32_t>(strangers_); order()[s] >= known) {
    const auto isStranger = [&](std::int32_t t) { return order()[t] >= known; };
    const auto end = query.near.begin() + static_cast<std::ptrdiff_t>(query.found);
    query.found = static_cast<std::size_t>(std::remove_if(row, end, isStranger) - query.near.begin());
  }
  const auto count = static_cast<std::int32_t>(query.found - begin);
  rowStart_[s + 1] = count, firstPair_[s + 1] = 0;
  for (std::int32_t k = 0; k < count; ++k) firstPair_[s + 1] += row[k] > s;
  for (const std::int32_t holder : query.holders) finder.nestings.push_back({s, holder});
}

/// Puts the rows, found by several threads, one after the other.
void OverlapPairs::joinRows() {
  rowStart_[0] = firstPair_[0] = 0;
  for (std::int32_t s = 0; s < size(); ++s)
    rowStart_[s + 1] += rowStart_[s], firstPair_[s + 1] += firstPair_[s];
  candidate_.resize(slots() + kLanes), pair_.resize(slots() + kLanes);
  std::fill_n(pair_.data() + slots(), kLanes, 0);  // whole registers read on behind the last row
  tbb::parallel_for(std::size_t{0}, pieces_.size(), [&](std::size_t piece) {
    const std::int32_t first = static_cast<std::int32_t>(piece) * kClusterGrain * BallTree::kFan;
    const std::int32_t last = std::min(first + kClusterGrain * BallTree::kFan, size());
    const auto from =
        pieces_[piece].finder->query.near.begin() + static_cast<std::ptrdiff_t>(pieces_[piece].begin);
    std::copy_n(from, rowStart_[last] - rowStart_[first], candidate_.data() + rowStart_[first]);
  });
  nestings_.clear();
  for (const Finder& finder : finders_)
    nestings_.insert(nestings_.end(), finder.nestings.begin(), finder.nestings.end());
}

/// The slot from which on the candidates of rank s, ascending, have higher ranks.
std::int32_t OverlapPairs::higherStart(std::int32_t s) const {
  return rowStart_[s + 1] - (firstPair_[s + 1] - firstPair_[s]);
}

/// Numbers the pairs along the rows of their bubbles of lower rank.
void OverlapPairs::numberPairs() {
  tbb::parallel_for(std::int32_t{0}, (size() + kNumberGrain - 1) / kNumberGrain, [&](std::int32_t block) {
    numberBlock(block * kNumberGrain, std::min((block + 1) * kNumberGrain, size()));
  });
}

/// Numbers those in the rows `begin` .. `end` - 1. A bubble of these rows meets its candidates of higher rank
/// in the order of its own row, so it is known which is next; in a row before them it has to be looked for.
void OverlapPairs::numberBlock(std::int32_t begin, std::int32_t end) {
  std::array<std::int32_t, kNumberGrain> next;
  for (std::int32_t s = begin; s < end; ++s) {
    next[s - begin] = firstPair_[s];
    std::int32_t slot = rowStart_[s];
    const std::int32_t higher = upperStart_[s] = higherStart(s);
    for (; slot < higher && candidate_[slot] < begin; ++slot) {
      const std::int32_t t = candidate_[slot], first = higherStart(t);
      pair_[slot] = firstPair_[t];
      for (std::int32_t k = first; k < rowStart_[t + 1]; ++k) pair_[slot] += candidate_[k] < s;
    }
    for (; slot < higher; ++slot) pair_[slot] = next[candidate_[slot] - begin]++;
    for (std::int32_t number = firstPair_[s]; slot < rowStart_[s + 1]; ++slot) pair_[slot] = number++;
  }
}

/// Sorts the rows by input index.
void OverlapPairs::sortRows() {
  struct Candidate {
    std::int32_t index, rank, pair;
  };
  forEachBlock(static_cast<std::size_t>(size()), [&](std::size_t begin, std::size_t end) {
    std::vector<Candidate> row;
    for (std::size_t s = begin; s < end; ++s) {
      row.clear();
      for (std::int32_t slot = rowStart_[s]; slot < rowStart_[s + 1]; ++slot)
        row.push_back({order()[candidate_[slot]], candidate_[slot], pair_[slot]});
      std::sort(row.begin(), row.end(),
                [](const Candidate& a, const Candidate& b) { return a.index < b.index; });
      std::int32_t slot = upperStart_[s] = rowStart_[s];
      for (const Candidate& candidate : row) {
        candidate_[slot] = candidate.rank, pair_[slot++] = candidate.pair;
        upperStart_[s] += candidate.index < order()[s];
      }
    }
  });
}

}  // namespace spume::foam
