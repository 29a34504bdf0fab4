#include "foam/ball_tree.h"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "foam/cell_hash.h"
#include "foam/parallel.h"

namespace spume::foam {

namespace {

constexpr int kClasses = 64;        ///< sizes told apart: 2^64 from smallest to largest
constexpr double kNowhere = 1e200;  ///< its square is infinite: nothing reaches it
constexpr auto kInfinity = std::numeric_limits<double>::infinity();
static_assert(BallTree::kFan % kLanes == 0);

Eigen::Vector3d lowCorner(const std::vector<Eigen::Vector3d>& position) {
  return reduceIndices(
      position.size(), position[0], [&](std::size_t i) { return position[i]; },
      [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return a.cwiseMin(b).eval(); });
}

std::size_t wholeClusters(std::size_t count) {
  return (count + BallTree::kFan - 1) / BallTree::kFan * BallTree::kFan;
}

}  // namespace

void BallTree::Level::resize(std::int32_t boxes) {
  count = boxes;
  for (auto& column : low) column.assign(wholeClusters(static_cast<std::size_t>(boxes)), kInfinity);
  for (auto& column : high) column.assign(wholeClusters(static_cast<std::size_t>(boxes)), -kInfinity);
}

void BallTree::build(const std::vector<Eigen::Vector3d>& position, const std::vector<double>& radius,
                     double reach) {
  const std::size_t n = radius.size(), padded = wholeClusters(n);
  order_.resize(n), index_.resize(padded);
  height_ = 0;
  if (n == 0) return;
  sort(position, radius);
  for (auto* column : {&x_, &y_, &z_, &far_}) column->resize(padded);
  forEachIndex(n, [&](std::size_t s) {
    const std::int32_t i = order_[s] = index_[s] = keys_[s].index;
    x_[s] = position[i].x(), y_[s] = position[i].y(), z_[s] = position[i].z(), far_[s] = reach * radius[i];
  });
  for (std::size_t s = n; s < padded; ++s) x_[s] = y_[s] = z_[s] = kNowhere, far_[s] = 0, index_[s] = 0;
  boxClusters();
}

/// Cells of the curve are as wide as the balls of the class. Coordinates wrap far out, which costs time but
/// finds the same.
void BallTree::sort(const std::vector<Eigen::Vector3d>& position, const std::vector<double>& radius) {
  const Eigen::Vector3d low = lowCorner(position);
  const int top = std::ilogb(*std::max_element(radius.begin(), radius.end()));
  keys_.resize(radius.size());
  forEachIndex(radius.size(), [&](std::size_t i) {
    const int octave = std::ilogb(radius[i]);
    const auto number = static_cast<std::uint64_t>(std::min(top - octave, kClasses - 1));
    std::uint64_t code = 0;
    for (int axis = 0; axis < 3; ++axis)
      code |= spreadCellBits(cellCoordinate(position[i][axis] - low[axis], std::ldexp(1.0, octave))) << axis;
    keys_[i] = {number << (3 * kCellAxisBits) | code, static_cast<std::int32_t>(i)};
  });
  tbb::parallel_sort(keys_.begin(), keys_.end());
}

void BallTree::boxClusters() {
  if (levels_.empty()) levels_.emplace_back();
  levels_[0].resize(clusters());
  const std::vector<double>* centre[3] = {&x_, &y_, &z_};
  forEachIndex(static_cast<std::size_t>(clusters()), [&](std::size_t cluster) {
    const std::size_t begin = cluster * kFan, end = std::min(begin + kFan, order_.size());
    for (int axis = 0; axis < 3; ++axis)
      for (std::size_t s = begin; s < end; ++s) {
        double &low = levels_[0].low[axis][cluster], &high = levels_[0].high[axis][cluster];
        low = std::min(low, (*centre[axis])[s] - far_[s]);
        high = std::max(high, (*centre[axis])[s] + far_[s]);
      }
  });
  for (height_ = 1; levels_[height_ - 1].count > kFan; ++height_) {
    if (static_cast<std::int32_t>(levels_.size()) == height_) levels_.emplace_back();
    boxLevel(levels_[height_ - 1], levels_[height_]);
  }
}

void BallTree::boxLevel(const Level& finer, Level& coarser) const {
  coarser.resize((finer.count + kFan - 1) / kFan);
  for (int axis = 0; axis < 3; ++axis)
    for (std::int32_t box = 0; box < coarser.count; ++box) {
      const auto begin = box * kFan;
      coarser.low[axis][box] = *std::min_element(&finer.low[axis][begin], &finer.low[axis][begin] + kFan);
      coarser.high[axis][box] = *std::max_element(&finer.high[axis][begin], &finer.high[axis][begin] + kFan);
    }
}

/// Which boxes of a block of eight meet a box, as bits.
std::uint32_t BallTree::meets(const Level& level, std::int32_t block, const double* low,
                              const double* high) const {
  std::uint32_t bits = 0;
  for (std::size_t k = 0; k < kFan; k += kLanes) {
    LaneMask mask = LaneMask{} - 1;
    for (int axis = 0; axis < 3; ++axis)
      mask &= (loadLanes(&level.low[axis][block * kFan + k]) < high[axis]) &
              (loadLanes(&level.high[axis][block * kFan + k]) > low[axis]);
    bits |= bitsOf(mask) << k;
  }
  return bits;
}

void BallTree::openCluster(std::int32_t cluster, Query& query) const {
  double low[3], high[3];
  for (int axis = 0; axis < 3; ++axis)
    low[axis] = levels_[0].low[axis][cluster], high[axis] = levels_[0].high[axis][cluster];
  query.clusters.clear();
  query.stack.assign(1, 0);
  // A block is told by its place in its level, and by the level.
  std::vector<std::int32_t>& stack = query.stack;
  stack.push_back(height_ - 1);
  while (!stack.empty()) {
    const std::int32_t level = stack.back(), block = stack[stack.size() - 2];
    stack.resize(stack.size() - 2);
    for (std::uint32_t bits = meets(levels_[level], block, low, high); bits != 0; bits &= bits - 1) {
      const std::int32_t box = block * kFan + std::countr_zero(bits);
      if (level == 0)
        query.clusters.push_back(box);
      else
        stack.push_back(box), stack.push_back(level - 1);
    }
  }
}

void BallTree::findNear(std::int32_t s, Query& query) const {
  const double x = x_[s], y = y_[s], z = z_[s], far = far_[s];
  query.near.resize(query.clusters.size() * kFan + kFan);
  std::int32_t* end = query.near.data();
  for (const std::int32_t cluster : query.clusters)
    for (std::size_t k = 0; k < kFan; k += kLanes) {
      const std::size_t t = static_cast<std::size_t>(cluster) * kFan + k;
      const Lanes dx = loadLanes(&x_[t]) - x, dy = loadLanes(&y_[t]) - y, dz = loadLanes(&z_[t]) - z,
                  near = loadLanes(&far_[t]) + far;
      std::uint32_t bits = bitsOf(dx * dx + dy * dy + dz * dz < near * near);
      if (const std::size_t own = static_cast<std::size_t>(s) - t; own < kLanes) bits &= ~(1u << own);
      end += storeSelected(bits, &index_[t], end);
    }
  query.near.resize(static_cast<std::size_t>(end - query.near.data()));
}

}  // namespace spume::foam
