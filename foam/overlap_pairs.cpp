#include "foam/overlap_pairs.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "foam/parallel.h"

namespace spume::foam {
namespace {

constexpr std::int32_t kClusterGrain = 16;                            ///< clusters per parallel task
constexpr std::int32_t kPieceBalls = kClusterGrain * BallTree::kFan;  ///< and balls
constexpr std::int32_t kParts = 4, kLeastPart = 2048;                 ///< of the ranks, each filled by a task

/// Calls body(begin, end) for parts of the ranks, in parallel.
template <typename Body>
void forEachPart(std::int32_t count, const Body& body) {
  const std::int32_t part = std::max((count + kParts - 1) / kParts, kLeastPart);
  tbb::parallel_for(std::int32_t{0}, (count + part - 1) / part,
                    [&](std::int32_t k) { body(k * part, std::min((k + 1) * part, count)); });
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
  findPairs();
  startRows();
  fillRows();
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

/// Each bubble finds those of higher rank, so each pair is tested once and no thread waits for another.
void OverlapPairs::findPairs() {
  firstPair_.resize(static_cast<std::size_t>(size()) + 1);
  pieces_.resize(static_cast<std::size_t>(tree_.clusters() + kClusterGrain - 1) / kClusterGrain);
  for (BallTree::Query& query : queries_) query.found = 0, query.group = -1, query.nestings.clear();
  tbb::parallel_for(std::size_t{0}, pieces_.size(), [&](std::size_t piece) {
    BallTree::Query& query = queries_.local();
    pieces_[piece] = {&query, query.found};
    const auto first = static_cast<std::int32_t>(piece) * kClusterGrain;
    for (std::int32_t c = first; c < std::min(first + kClusterGrain, tree_.clusters()); ++c) {
      tree_.openCluster(c, query);
      for (std::int32_t s = c * BallTree::kFan; s < std::min((c + 1) * BallTree::kFan, size()); ++s)
        findHigher(s, query);
    }
    for (std::size_t k = pieces_[piece].begin; k < query.found; ++k)
      pieces_[piece].farthest = std::max(pieces_[piece].farthest, query.near[k]);
  });
  nestings_.clear();
  for (const BallTree::Query& query : queries_)
    nestings_.insert(nestings_.end(), query.nestings.begin(), query.nestings.end());
}

void OverlapPairs::findHigher(std::int32_t s, BallTree::Query& query) {
  const std::size_t begin = query.found;
  tree_.findLater(s, query);
  if (const std::int32_t known = size() - static_cast<std::int32_t>(strangers_); order()[s] >= known) {
    const auto place = [&](std::size_t k) { return query.near.begin() + static_cast<std::ptrdiff_t>(k); };
    const auto isStranger = [&](std::int32_t t) { return order()[t] >= known; };
    const auto end = std::remove_if(place(begin), place(query.found), isStranger);
    query.found = static_cast<std::size_t>(end - query.near.begin());
  }
  firstPair_[s + 1] = static_cast<std::int32_t>(query.found - begin);
}

/// Calls visit(s, t, pair) for all pairs of ranks s < t with t in `begin` .. `end` - 1, by ascending s.
template <typename Visit>
void OverlapPairs::forEachPairWith(std::int32_t begin, std::int32_t end, const Visit& visit) const {
  for (std::int32_t first = 0; first < end; first += kPieceBalls) {
    const Piece& piece = pieces_[first / kPieceBalls];
    if (piece.farthest < begin) continue;
    const std::int32_t* higher = piece.query->near.data() + piece.begin;
    for (std::int32_t s = first; s < std::min(first + kPieceBalls, size()); ++s) {
      std::int32_t pair = firstPair_[s], last = firstPair_[s + 1];
      const std::int32_t *t = higher, *rowEnd = higher += last - pair;
      if (pair == last || rowEnd[-1] < begin) continue;
      for (; *t < begin; ++t) ++pair;
      for (; t != rowEnd && *t < end; ++t) visit(s, *t, pair++);
    }
  }
}

/// Numbers the pairs, and finds where the rows begin.
void OverlapPairs::startRows() {
  firstPair_[0] = 0;
  for (std::int32_t s = 0; s < size(); ++s) firstPair_[s + 1] += firstPair_[s];
  rowStart_.resize(firstPair_.size()), upperStart_.resize(static_cast<std::size_t>(size()));
  forEachPart(size(), [&](std::int32_t begin, std::int32_t end) {
    std::fill(upperStart_.begin() + begin, upperStart_.begin() + end, 0);
    forEachPairWith(begin, end, [&](std::int32_t, std::int32_t t, std::int32_t) { ++upperStart_[t]; });
  });
  rowStart_[0] = 0;
  for (std::int32_t s = 0; s < size(); ++s)
    rowStart_[s + 1] = rowStart_[s] + upperStart_[s] + firstPair_[s + 1] - firstPair_[s];
  candidate_.resize(slots() + kLanes), pair_.resize(slots() + kLanes);
  std::fill_n(pair_.data() + slots(), kLanes, 0);  // whole registers read on behind the last row
}

/// Lists the pairs in the rows of both, by ascending rank.
void OverlapPairs::fillRows() {
  forEachPart(size(), [&](std::int32_t begin, std::int32_t end) {
    std::copy(rowStart_.begin() + begin, rowStart_.begin() + end, upperStart_.begin() + begin);
    forEachPairWith(begin, end, [&](std::int32_t s, std::int32_t t, std::int32_t pair) {
      const std::int32_t slot = upperStart_[t]++;
      candidate_[slot] = s, pair_[slot] = pair;
    });
  });
  tbb::parallel_for(std::size_t{0}, pieces_.size(), [&](std::size_t piece) {
    const std::int32_t* higher = pieces_[piece].query->near.data() + pieces_[piece].begin;
    const auto first = static_cast<std::int32_t>(piece) * kPieceBalls;
    for (std::int32_t s = first; s < std::min(first + kPieceBalls, size()); ++s)
      for (std::int32_t slot = upperStart_[s], pair = firstPair_[s]; slot < rowStart_[s + 1]; ++slot)
        candidate_[slot] = *higher++, pair_[slot] = pair++;
  });
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
