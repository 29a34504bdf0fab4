#include "foam/overlap_pairs.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>

#include "foam/cell_hash.h"
#include "foam/lane_math.h"
#include "foam/parallel.h"

namespace spume::foam {

namespace {

constexpr int kMaxLevels = 64;          ///< radius octaves told apart: 2^64 from smallest to largest
constexpr std::size_t kCellGrain = 64;  ///< cells per parallel task

}  // namespace

/// One grid level per radius octave, all levels in one hash.
struct OverlapPairs::Levels {
  struct Level {
    int number;
    double cellSize, maxRadius;  ///< [m]
  };
  std::vector<Level> used;               ///< from small to large bubbles
  std::vector<std::uint8_t> usedOfRank;  ///< index into `used`
  std::vector<std::int32_t>
      cellStart;  ///< first rank of each cell that is not empty, then the number of ranks
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
  void startCells(const std::vector<Sorted>& sorted,
                  const std::vector<std::pair<std::uint64_t, std::int32_t>>& keys);
  template <typename Visit>
  void visitBox(const Level& level, const Eigen::Vector3d& low, const Eigen::Vector3d& high,
                const Visit& visit) const;
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

/// Calls visit(run) for all cells of `level` that the box meets. A box around one cell of the same or a finer
/// level, widened by at most one cell each way, meets up to four cells along each axis.
template <typename Visit>
void OverlapPairs::Levels::visitBox(const Level& level, const Eigen::Vector3d& low,
                                    const Eigen::Vector3d& high, const Visit& visit) const {
  constexpr std::int64_t kMostCells = 4;
  std::uint64_t part[3][kMostCells];
  std::int64_t count[3];
  for (int axis = 0; axis < 3; ++axis) {
    const std::int64_t first = cellCoordinate(low[axis], level.cellSize);
    count[axis] = std::min(kMostCells, cellCoordinate(high[axis], level.cellSize) - first + 1);
    for (int k = 0; k < count[axis]; ++k) part[axis][k] = spreadCellBits(first + k) << axis;
  }
  const std::uint64_t levelPart = static_cast<std::uint64_t>(level.number) << (3 * kCellAxisBits);
  for (int z = 0; z < count[2]; ++z)
    for (int y = 0; y < count[1]; ++y)
      for (int k = 0; k < count[0]; ++k) visit(cells[levelPart | part[0][k] | part[1][y] | part[2][z]]);
}

bool OverlapPairs::update(const std::vector<Eigen::Vector3d>& position, const std::vector<double>& radius) {
  if (stillValid(position, radius)) return false;
  builtPosition_ = position;
  builtRadius_ = radius;
  fillRows(findPairs(sortIntoCells()));
  return true;
}

/// Motion common to all bubbles brings none nearer to another: it need not count.
bool OverlapPairs::stillValid(const std::vector<Eigen::Vector3d>& position,
                              const std::vector<double>& radius) const {
  const std::size_t n = radius.size();
  if (n != builtRadius_.size() || rows_.start.empty()) return false;
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
  levels.startCells(sorted_, keys);
  return levels;
}

/// Lists the cells. Coordinates wrap, so that bubbles with one key can be far apart: those count as cells of
/// their own.
void OverlapPairs::Levels::startCells(const std::vector<Sorted>& sorted,
                                      const std::vector<std::pair<std::uint64_t, std::int32_t>>& keys) {
  cellStart.clear();
  for (std::size_t s = 0; s < keys.size(); ++s) {
    const bool sameKey = s > 0 && keys[s].first == keys[s - 1].first;
    if (sameKey) {
      const Eigen::Vector3d apart = sorted[s].position - sorted[cellStart.back()].position;
      if (apart.cwiseAbs().maxCoeff() <= used[usedOfRank[s]].cellSize) continue;
    }
    cellStart.push_back(static_cast<std::int32_t>(s));
  }
  cellStart.push_back(static_cast<std::int32_t>(keys.size()));
}

/// Finds the pairs of the bubbles of one cell, all at once: what is near one of them is near all.
class OverlapPairs::CellSearch {
 public:
  CellSearch(const Levels& levels, const std::vector<Sorted>& sorted) : levels_(levels), sorted_(sorted) {}

  /// Appends the pairs of bubbles begin .. end - 1, all of one cell, with bubbles of later rank or of coarser
  /// levels.
  void find(std::int32_t begin, std::int32_t end, Half& pairs) {
    Eigen::Vector3d low = sorted_[begin].position, high = low;
    double largest = 0;
    for (std::int32_t s = begin; s < end; ++s) {
      low = low.cwiseMin(sorted_[s].position), high = high.cwiseMax(sorted_[s].position);
      largest = std::max(largest, sorted_[s].radius);
    }
    runs_.clear();
    const std::size_t own = levels_.usedOfRank[begin];
    for (std::size_t l = own; l < levels_.used.size(); ++l) {
      const double reach = (1 + kSkin) * (largest + levels_.used[l].maxRadius);
      levels_.visitBox(levels_.used[l], low.array() - reach, high.array() + reach,
                       [&](const CellHash::Run& run) {
                         const std::int32_t first = l == own ? std::max(run.begin, begin) : run.begin;
                         if (first < run.end) runs_.emplace_back(first, run.end);
                       });
    }
    gather();
    for (std::int32_t s = begin; s < end; ++s) test(s, pairs);
  }

 private:
  /// Copies what lies in the runs side by side.
  void gather() {
    constexpr double kNowhere = 1e200;  // its square is infinite: nothing reaches it
    count_ = 0;
    for (const auto& [first, last] : runs_) count_ += static_cast<std::size_t>(last - first);
    const std::size_t padded = paddedToLanes(count_);
    if (x_.size() < padded) {
      for (auto* column : {&x_, &y_, &z_, &r_}) column->resize(padded);
      rank_.resize(padded), hit_.resize(padded), near_.resize(padded);
    }
    std::size_t k = 0;
    for (const auto& [first, last] : runs_)
      for (std::int32_t t = first; t < last; ++t, ++k) {
        const auto& [position, radius] = sorted_[t];
        x_[k] = position.x(), y_[k] = position.y(), z_[k] = position.z(), r_[k] = radius, rank_[k] = t;
      }
    for (; k < padded; ++k) x_[k] = y_[k] = z_[k] = kNowhere, r_[k] = 0;
  }

  void test(std::int32_t s, Half& pairs) {
    const auto& [position, radius] = sorted_[s];
    for (std::size_t k = 0; k < count_; k += kLanes) {
      const Lanes dx = loadLanes(&x_[k]) - position.x(), dy = loadLanes(&y_[k]) - position.y(),
                  dz = loadLanes(&z_[k]) - position.z(), reach = (1 + kSkin) * (loadLanes(&r_[k]) + radius);
      const LaneMask near = dx * dx + dy * dy + dz * dz < reach * reach;
      std::memcpy(&near_[k], &near, sizeof near);
    }
    // Without branches: about one in ten is a hit, at no place that could be foreseen.
    std::size_t hits = 0;
    for (std::size_t k = 0; k < count_; ++k) {
      hit_[hits] = rank_[k];
      hits += static_cast<std::size_t>(-near_[k]) & static_cast<std::size_t>(rank_[k] > s);
    }
    for (std::size_t k = 0; k < hits; ++k) pairs.emplace_back(s, hit_[k]);
  }

  const Levels& levels_;
  const std::vector<Sorted>& sorted_;
  std::vector<std::pair<std::int32_t, std::int32_t>> runs_;  ///< of ranks near the cell
  std::size_t count_ = 0;                                    ///< of bubbles in them
  std::vector<std::int32_t> rank_, hit_;
  std::vector<std::int64_t> near_;  ///< -1 or 0
  std::vector<double> x_, y_, z_, r_;
};

/// Coarser levels have later ranks, so that each pair is found once, from its bubble of lower rank.
std::vector<OverlapPairs::Half> OverlapPairs::findPairs(const Levels& levels) const {
  const std::size_t cells = levels.cellStart.size() - 1;
  std::vector<Half> found((cells + kCellGrain - 1) / kCellGrain);
  tbb::parallel_for(std::size_t{0}, found.size(), [&](std::size_t chunk) {
    CellSearch search(levels, sorted_);
    const std::size_t end = std::min(cells, (chunk + 1) * kCellGrain);
    for (std::size_t c = chunk * kCellGrain; c < end; ++c)
      search.find(levels.cellStart[c], levels.cellStart[c + 1], found[chunk]);
  });
  return found;
}

/// Turns the pairs, each found once, into rows that hold each twice, sorted by input index.
void OverlapPairs::fillRows(const std::vector<Half>& found) {
  const std::size_t n = order_.size();
  const auto entryOf = [&](std::int32_t s) { return PairRows::pack(order_[s], s); };
  rows_.build(n, [&](const auto& body) {
    tbb::parallel_for(std::size_t{0}, found.size(), [&](std::size_t chunk) {
      for (const auto& [s, t] : found[chunk]) body(s, t, entryOf(t), entryOf(s));
    });
  });
  candidate_.resize(rows_.entry.size()), mirror_.resize(rows_.entry.size());
  forEachIndex(n, [&](std::size_t s) {
    for (std::int32_t slot = rows_.start[s]; slot < rows_.start[s + 1]; ++slot) {
      const std::int32_t t = candidate_[slot] = PairRows::valueOf(rows_.entry[slot]);
      if (t < static_cast<std::int32_t>(s)) continue;
      const auto row = rows_.entry.begin() + rows_.start[t], end = rows_.entry.begin() + rows_.start[t + 1];
      const auto there = std::lower_bound(row, end, entryOf(static_cast<std::int32_t>(s)));
      mirror_[slot] = static_cast<std::int32_t>(there - rows_.entry.begin());
      mirror_[mirror_[slot]] = slot;
    }
  });
}

}  // namespace spume::foam
