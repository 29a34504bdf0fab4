#include "foam/overlap_pairs.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "foam/cell_hash.h"

namespace spume::foam {

namespace {

constexpr int kMaxLevels = 64;       ///< radius octaves told apart: 2^64 from smallest to largest
constexpr std::size_t kGrain = 512;  ///< bubbles per parallel task

template <typename Body>
void forEachIndex(std::size_t count, const Body& body) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, kGrain), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) body(i);
  });
}

}  // namespace

/// One grid level per radius octave, all levels in one hash.
struct OverlapPairs::Levels {
  struct Level {
    int number;
    double cellSize, maxRadius;  ///< [m]
  };
  std::vector<Level> used;               ///< from small to large bubbles
  std::vector<std::uint8_t> usedOfRank;  ///< index into `used`
  int topOctave = 0;
  CellHash cells;

  explicit Levels(const std::vector<double>& radius);
  int numberOf(double radius) const {
    return std::clamp(kMaxLevels - 1 - (topOctave - std::ilogb(radius)), 0, kMaxLevels - 1);
  }
  std::size_t indexOf(double radius) const {
    std::size_t index = 0;
    while (used[index].number < numberOf(radius)) ++index;
    return index;
  }
  std::uint64_t keyOf(double radius, const Eigen::Vector3d& x) const;
  template <typename Visit>
  void visitBox(const Level& level, const Eigen::Vector3d& x, double reach, const Visit& visit) const;
};

OverlapPairs::Levels::Levels(const std::vector<double>& radius) {
  if (radius.empty()) return;
  topOctave = std::ilogb(*std::max_element(radius.begin(), radius.end()));
  double maxRadius[kMaxLevels] = {};
  for (double r : radius) maxRadius[numberOf(r)] = std::max(maxRadius[numberOf(r)], r);
  for (int number = 0; number < kMaxLevels; ++number)
    if (maxRadius[number] > 0)
      used.push_back({number, 2 * (1 + kSkin) * maxRadius[number], maxRadius[number]});
}

std::uint64_t OverlapPairs::Levels::keyOf(double radius, const Eigen::Vector3d& x) const {
  const Level& level = used[indexOf(radius)];
  std::uint64_t key = static_cast<std::uint64_t>(level.number) << (3 * kCellAxisBits);
  for (int axis = 0; axis < 3; ++axis) key |= spreadCellBits(cellCoordinate(x[axis], level.cellSize)) << axis;
  return key;
}

/// Calls visit(rank) for the bubbles in all cells of `level` that the cube of half-width `reach` around x
/// meets; reach is at most one cell, so these are up to three cells along each axis.
template <typename Visit>
void OverlapPairs::Levels::visitBox(const Level& level, const Eigen::Vector3d& x, double reach,
                                    const Visit& visit) const {
  std::uint64_t part[3][4];
  int count[3];
  for (int axis = 0; axis < 3; ++axis) {
    const std::int64_t low = cellCoordinate(x[axis] - reach, level.cellSize);
    count[axis] =
        static_cast<int>(std::min<std::int64_t>(3, cellCoordinate(x[axis] + reach, level.cellSize) - low)) +
        1;
    for (int k = 0; k < count[axis]; ++k) part[axis][k] = spreadCellBits(low + k) << axis;
  }
  const std::uint64_t levelPart = static_cast<std::uint64_t>(level.number) << (3 * kCellAxisBits);
  for (int z = 0; z < count[2]; ++z)
    for (int y = 0; y < count[1]; ++y)
      for (int k = 0; k < count[0]; ++k) {
        const CellHash::Run& run = cells[levelPart | part[0][k] | part[1][y] | part[2][z]];
        for (std::int32_t rank = run.begin; rank < run.end; ++rank) visit(rank);
      }
}

bool OverlapPairs::update(const std::vector<Eigen::Vector3d>& position, const std::vector<double>& radius) {
  if (stillValid(position, radius)) return false;
  builtPosition_ = position;
  builtRadius_ = radius;
  fillRows(findPairs(sortIntoCells()));
  return true;
}

bool OverlapPairs::stillValid(const std::vector<Eigen::Vector3d>& position,
                              const std::vector<double>& radius) const {
  if (position.size() != builtPosition_.size() || rowStart_.empty()) return false;
  std::atomic<bool> valid = true;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, radius.size(), kGrain), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end() && valid.load(std::memory_order_relaxed); ++i) {
      const double moved = (position[i] - builtPosition_[i]).norm() + std::abs(radius[i] - builtRadius_[i]);
      if (!(moved <= kSkin * builtRadius_[i])) valid.store(false, std::memory_order_relaxed);
    }
  });
  return valid;
}

/// Sorts the bubbles by level and cell: sets order_, rank_ and sorted_.
OverlapPairs::Levels OverlapPairs::sortIntoCells() {
  const std::size_t n = builtRadius_.size();
  Levels levels(builtRadius_);
  std::vector<std::pair<std::uint64_t, std::int32_t>> keys(n);
  forEachIndex(n, [&](std::size_t i) {
    keys[i] = {levels.keyOf(builtRadius_[i], builtPosition_[i]), static_cast<std::int32_t>(i)};
  });
  tbb::parallel_sort(keys.begin(), keys.end());
  order_.resize(n), rank_.resize(n), sorted_.resize(n), levels.usedOfRank.resize(n);
  forEachIndex(n, [&](std::size_t s) {
    const std::int32_t i = keys[s].second;
    order_[s] = i;
    rank_[i] = static_cast<std::int32_t>(s);
    sorted_[s] = {builtPosition_[i], builtRadius_[i]};
    levels.usedOfRank[s] = static_cast<std::uint8_t>(levels.indexOf(builtRadius_[i]));
  });
  levels.cells = CellHash(keys);
  return levels;
}

std::vector<OverlapPairs::Half> OverlapPairs::findPairs(const Levels& levels) const {
  const std::size_t n = order_.size();
  std::vector<Half> found((n + kGrain - 1) / kGrain);
  const auto findFor = [&](std::int32_t s, Half& pairs) {
    const auto [x, r] = sorted_[s];
    for (std::size_t l = levels.usedOfRank[s]; l < levels.used.size(); ++l) {
      const std::int32_t after = l == levels.usedOfRank[s] ? s : -1;  // within a level each pair is met twice
      levels.visitBox(levels.used[l], x, (1 + kSkin) * (r + levels.used[l].maxRadius), [&](std::int32_t t) {
        const double reach = (1 + kSkin) * (r + sorted_[t].radius);
        if (t > after && (sorted_[t].position - x).squaredNorm() < reach * reach) pairs.emplace_back(s, t);
      });
    }
  };
  tbb::parallel_for(std::size_t{0}, found.size(), [&](std::size_t chunk) {
    found[chunk].reserve(8 * kGrain);
    const std::size_t end = std::min(n, (chunk + 1) * kGrain);
    for (std::size_t s = chunk * kGrain; s < end; ++s) findFor(static_cast<std::int32_t>(s), found[chunk]);
  });
  return found;
}

/// Turns the pairs, each found once, into rows that hold each twice, sorted by input index.
void OverlapPairs::fillRows(const std::vector<Half>& found) {
  const std::size_t n = order_.size();
  rowStart_.assign(n + 1, 0);
  for (const Half& pairs : found)
    for (const auto& [s, t] : pairs) ++rowStart_[s + 1], ++rowStart_[t + 1];
  for (std::size_t s = 0; s < n; ++s) rowStart_[s + 1] += rowStart_[s];
  candidate_.resize(rowStart_.back());
  mirror_.resize(rowStart_.back());
  std::vector<std::int32_t> next(rowStart_.begin(), rowStart_.end() - 1);
  for (const Half& pairs : found)
    for (const auto& [s, t] : pairs) candidate_[next[s]++] = t, candidate_[next[t]++] = s;
  forEachIndex(n, [&](std::size_t s) {
    std::sort(candidate_.begin() + rowStart_[s], candidate_.begin() + rowStart_[s + 1],
              [&](std::int32_t a, std::int32_t b) { return order_[a] < order_[b]; });
  });
  // Visiting the rows by input index meets the entries of every other row in their sorted order.
  std::copy(rowStart_.begin(), rowStart_.end() - 1, next.begin());
  for (std::size_t i = 0; i < n; ++i)
    for (std::int32_t slot = rowStart_[rank_[i]]; slot < rowStart_[rank_[i] + 1]; ++slot)
      mirror_[slot] = next[candidate_[slot]]++;
}

}  // namespace spume::foam
