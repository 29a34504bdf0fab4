#include "foam/overlap_pairs.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>

namespace spume::foam {

namespace {

constexpr int kAxisBits =
    19;  ///< of a cell coordinate in a key; coordinates wrap, which only adds candidates to reject
constexpr int kMaxLevels = 64;       ///< radius octaves told apart: 2^64 from smallest to largest
constexpr std::size_t kGrain = 512;  ///< bubbles per parallel task
constexpr std::uint64_t kAxisMask = (1ull << kAxisBits) - 1;

/// Spreads the lowest 19 bits of `v` to every third bit.
std::uint64_t spreadBits(std::uint64_t v) {
  v &= kAxisMask;
  v = (v | v << 32) & 0x1f00000000ffffull;
  v = (v | v << 16) & 0x1f0000ff0000ffull;
  v = (v | v << 8) & 0x100f00f00f00f00full;
  v = (v | v << 4) & 0x10c30c30c30c30c3ull;
  return (v | v << 2) & 0x1249249249249249ull;
}

std::uint64_t cellKey(int level, std::int64_t x, std::int64_t y, std::int64_t z) {
  const auto morton = spreadBits(static_cast<std::uint64_t>(x)) |
                      spreadBits(static_cast<std::uint64_t>(y)) << 1 |
                      spreadBits(static_cast<std::uint64_t>(z)) << 2;
  return static_cast<std::uint64_t>(level) << (3 * kAxisBits) | morton;
}

/// Cell coordinate of x [m]; far beyond any simulation it saturates instead of overflowing.
std::int64_t cellOf(double x, double cellSize) {
  constexpr double kFarthest = 0x1p60;
  return static_cast<std::int64_t>(std::floor(std::clamp(x / cellSize, -kFarthest, kFarthest)));
}

template <typename Body>
void forEachIndex(std::size_t count, const Body& body) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, kGrain), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) body(i);
  });
}

}  // namespace

/// One grid level per radius octave, and a hash from cell keys to runs of ranks.
struct OverlapPairs::CellTable {
  struct Level {
    double cellSize = 0, maxRadius = 0;
    bool used = false;
  };
  struct Run {
    std::uint64_t key = ~0ull;
    std::int32_t begin = 0, end = 0;
  };

  std::vector<Level> levels = std::vector<Level>(kMaxLevels);
  int topOctave = 0;
  std::vector<Run> runs;  ///< open addressing, a power of two long, at most half full
  std::vector<std::uint8_t> levelOfRank;

  int levelOf(double radius) const {
    return std::clamp(kMaxLevels - 1 - (topOctave - std::ilogb(radius)), 0, kMaxLevels - 1);
  }
  std::uint64_t keyOf(int level, const Eigen::Vector3d& x) const {
    const double size = levels[level].cellSize;
    return cellKey(level, cellOf(x.x(), size), cellOf(x.y(), size), cellOf(x.z(), size));
  }
  std::size_t slotOf(std::uint64_t key) const {
    std::size_t slot = (key * 0x9e3779b97f4a7c15ull) >> 20 & (runs.size() - 1);
    while (runs[slot].key != key && runs[slot].key != ~0ull) slot = (slot + 1) & (runs.size() - 1);
    return slot;
  }
  void setLevels(const std::vector<double>& radius);
  void setRuns(const std::vector<std::pair<std::uint64_t, std::int32_t>>& sorted);
  template <typename Visit>
  void visitBox(int level, const Eigen::Vector3d& x, double reach, const Visit& visit) const;
};

void OverlapPairs::CellTable::setLevels(const std::vector<double>& radius) {
  topOctave = std::ilogb(*std::max_element(radius.begin(), radius.end()));
  for (double r : radius) {
    Level& level = levels[levelOf(r)];
    level.used = true;
    level.maxRadius = std::max(level.maxRadius, r);
  }
  for (Level& level : levels) level.cellSize = 2 * (1 + kSkin) * level.maxRadius;
}

void OverlapPairs::CellTable::setRuns(const std::vector<std::pair<std::uint64_t, std::int32_t>>& sorted) {
  runs.assign(std::bit_ceil(2 * sorted.size() + 2), {});
  levelOfRank.resize(sorted.size());
  for (std::size_t begin = 0, end = 0; begin < sorted.size(); begin = end) {
    const std::uint64_t key = sorted[begin].first;
    for (end = begin; end < sorted.size() && sorted[end].first == key; ++end)
      levelOfRank[end] = static_cast<std::uint8_t>(key >> (3 * kAxisBits));
    runs[slotOf(key)] = {key, static_cast<std::int32_t>(begin), static_cast<std::int32_t>(end)};
  }
}

/// Calls visit(rank) for the bubbles in all cells of `level` that the cube of half-width `reach` around x
/// meets.
template <typename Visit>
void OverlapPairs::CellTable::visitBox(int level, const Eigen::Vector3d& x, double reach,
                                       const Visit& visit) const {
  std::int64_t low[3], high[3];
  for (int axis = 0; axis < 3; ++axis) {
    low[axis] = cellOf(x[axis] - reach, levels[level].cellSize);
    high[axis] = cellOf(x[axis] + reach, levels[level].cellSize);
  }
  for (std::int64_t cz = low[2]; cz <= high[2]; ++cz)
    for (std::int64_t cy = low[1]; cy <= high[1]; ++cy)
      for (std::int64_t cx = low[0]; cx <= high[0]; ++cx) {
        const Run& run = runs[slotOf(cellKey(level, cx, cy, cz))];
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

OverlapPairs::CellTable OverlapPairs::sortIntoCells() {
  const std::size_t n = builtRadius_.size();
  CellTable cells;
  order_.resize(n);
  rank_.resize(n);
  if (n == 0) return cells;
  cells.setLevels(builtRadius_);
  std::vector<std::pair<std::uint64_t, std::int32_t>> sorted(n);
  forEachIndex(n, [&](std::size_t i) {
    sorted[i] = {cells.keyOf(cells.levelOf(builtRadius_[i]), builtPosition_[i]),
                 static_cast<std::int32_t>(i)};
  });
  tbb::parallel_sort(sorted.begin(), sorted.end());
  forEachIndex(n, [&](std::size_t s) {
    order_[s] = sorted[s].second;
    rank_[sorted[s].second] = static_cast<std::int32_t>(s);
  });
  cells.setRuns(sorted);
  return cells;
}

OverlapPairs::Half OverlapPairs::findPairs(const CellTable& cells) const {
  const std::size_t n = order_.size();
  const std::size_t chunks = (n + kGrain - 1) / kGrain;
  std::vector<Half> found(chunks);
  const auto findFor = [&](std::int32_t s, Half& pairs) {
    const Eigen::Vector3d& x = builtPosition_[order_[s]];
    const double r = builtRadius_[order_[s]];
    for (int level = cells.levelOfRank[s]; level < kMaxLevels; ++level) {
      if (!cells.levels[level].used) continue;
      const bool sameLevel = level == cells.levelOfRank[s];
      cells.visitBox(level, x, (1 + kSkin) * (r + cells.levels[level].maxRadius), [&](std::int32_t t) {
        if (sameLevel && t <= s) return;
        const double reach = (1 + kSkin) * (r + builtRadius_[order_[t]]);
        if ((builtPosition_[order_[t]] - x).squaredNorm() < reach * reach) pairs.emplace_back(s, t);
      });
    }
  };
  tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t chunk) {
    const std::size_t end = std::min(n, (chunk + 1) * kGrain);
    for (std::size_t s = chunk * kGrain; s < end; ++s) findFor(static_cast<std::int32_t>(s), found[chunk]);
  });
  Half pairs;
  for (const Half& part : found) pairs.insert(pairs.end(), part.begin(), part.end());
  return pairs;
}

void OverlapPairs::fillRows(const Half& pairs) {
  const std::size_t n = order_.size();
  rowStart_.assign(n + 1, 0);
  for (const auto& [s, t] : pairs) ++rowStart_[s + 1], ++rowStart_[t + 1];
  for (std::size_t s = 0; s < n; ++s) rowStart_[s + 1] += rowStart_[s];
  candidate_.resize(2 * pairs.size());
  mirror_.resize(2 * pairs.size());
  std::vector<std::int32_t> next(rowStart_.begin(), rowStart_.end() - 1);
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
