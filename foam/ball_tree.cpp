#include "foam/ball_tree.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>

#include "foam/cell_hash.h"
#include "foam/hilbert_curve.h"
#include "foam/parallel.h"

namespace spume::foam {

namespace {

/// Boxes are wider by that, relatively: some ulp, so that no ball is missed.
constexpr double kRoundOff = 4e-15;
constexpr double kTieSpare = 1e-8;  ///< of radii, which ties may change by less
constexpr double kNowhere = 1e200;  ///< its square is infinite: nothing reaches it
constexpr auto kInfinity = std::numeric_limits<double>::infinity();
constexpr int kFanBits = 3;
static_assert(BallTree::kFan == 1 << kFanBits && BallTree::kFan % kLanes == 0);

struct Bounds {
  Eigen::Vector3d low, high;
};

Bounds boundsOf(const std::vector<Eigen::Vector3d>& position) {
  return reduceIndices(
      position.size(), Bounds{position[0], position[0]},
      [&](std::size_t i) {
        return Bounds{position[i], position[i]};
      },
      [](const Bounds& a, const Bounds& b) {
        return Bounds{a.low.cwiseMin(b.low), a.high.cwiseMax(b.high)};
      });
}

/// The mean octave of the radii.
int usualOctave(const std::vector<double>& radius) {
  const auto octave = [&](std::size_t i) { return std::int64_t{std::ilogb(radius[i])}; };
  const std::int64_t sum = reduceIndices(radius.size(), std::int64_t{0}, octave, std::plus<>());
  return static_cast<int>(sum / static_cast<std::int64_t>(radius.size()));
}

/// Whether balls that follow each other are near each other: those of a foam in space order are some two
/// mean diameters apart, those in no order as far as the foam is wide.
bool isInSpaceOrder(const std::vector<Eigen::Vector3d>& position, const std::vector<double>& radius) {
  constexpr double kNearRadii = 8;
  const auto excess = [&](std::size_t i) {
    return i == 0 ? 0 : (position[i] - position[i - 1]).norm() - kNearRadii * radius[i];
  };
  return reduceIndices(radius.size(), 0.0, excess, std::plus<>()) <= 0;
}

std::size_t wholeClusters(std::size_t count) {
  return (count + BallTree::kFan - 1) / BallTree::kFan * BallTree::kFan;
}

/// Bits of the boxes from place `k` on that meet a box.
std::uint32_t meets(const BallTree::Boxes& boxes, std::size_t k, const BallTree::Box& box) {
  LaneMask mask = LaneMask{} - 1;
  for (int axis = 0; axis < 3; ++axis)
    mask &=
        (loadLanes(&boxes.low[axis][k]) < box.high[axis]) & (loadLanes(&boxes.high[axis][k]) > box.low[axis]);
  return bitsOf(mask) & lanesBelow(boxes.count - k);
}

/// Adds to `to` those of boxes `begin` .. `end` - 1 that meet a box.
void addMeeting(const BallTree::Boxes& from, std::size_t begin, std::size_t end, const BallTree::Box& box,
                BallTree::Boxes& to) {
  to.reserve(to.count + end - begin);
  for (std::size_t k = begin; k < end; k += kLanes) {
    const std::uint32_t bits = meets(from, k, box);
    for (int axis = 0; axis < 3; ++axis) {
      storeSelected(bits, loadLanes(&from.low[axis][k]), &to.low[axis][to.count]);
      storeSelected(bits, loadLanes(&from.high[axis][k]), &to.high[axis][to.count]);
    }
    to.count += storeSelected(bits, &from.number[k], &to.number[to.count]);
  }
}

/// The box around boxes `begin` .. `end` - 1.
BallTree::Box boxAround(const BallTree::Boxes& boxes, std::size_t begin, std::size_t end) {
  BallTree::Box box;
  for (int axis = 0; axis < 3; ++axis) {
    box.low[axis] = *std::min_element(&boxes.low[axis][begin], &boxes.low[axis][0] + end);
    box.high[axis] = *std::max_element(&boxes.high[axis][begin], &boxes.high[axis][0] + end);
  }
  return box;
}

}  // namespace

void BallTree::Boxes::reserve(std::size_t boxes) {
  const std::size_t room = wholeClusters(boxes) + kFan;
  if (number.size() >= room) return;
  number.resize(2 * room);
  for (int axis = 0; axis < 3; ++axis) low[axis].resize(2 * room), high[axis].resize(2 * room);
}

void BallTree::build(const std::vector<Eigen::Vector3d>& position, const std::vector<double>& radius,
                     double reach) {
  const std::size_t n = radius.size(), padded = wholeClusters(n);
  order_.resize(n);
  height_ = 0, reach_ = reach;
  if (n == 0) return;
  isInputOrder_ = isInSpaceOrder(position, radius);
  if (!isInputOrder_) sort(position, radius);
  for (auto* column : {&x_, &y_, &z_, &far_}) column->resize(padded);
  forEachIndex(n, [&](std::size_t s) {
    const std::int32_t i = order_[s] = isInputOrder_ ? static_cast<std::int32_t>(s) : keys_[s].index;
    x_[s] = position[i].x(), y_[s] = position[i].y(), z_[s] = position[i].z(), far_[s] = reach * radius[i];
  });
  for (std::size_t s = n; s < padded; ++s) x_[s] = y_[s] = z_[s] = kNowhere, far_[s] = 0;
  boxClusters();
}

/// Cells are half as wide as a usual ball's radius. Coordinates wrap far out, which costs time but finds the
/// same.
void BallTree::sort(const std::vector<Eigen::Vector3d>& position, const std::vector<double>& radius) {
  const auto [low, high] = boundsOf(position);
  const double size = std::ldexp(1.0, usualOctave(radius) - 1);
  const std::int64_t last = cellCoordinate((high - low).maxCoeff(), size);
  const int levels =
      std::min(static_cast<int>(std::bit_width(static_cast<std::uint64_t>(last))), kCellAxisBits);
  keys_.resize(radius.size()), spareKeys_.resize(radius.size());
  forEachIndex(radius.size(), [&](std::size_t i) {
    std::uint64_t code = 0;
    for (int axis = 0; axis < 3; ++axis)
      code |= spreadCellBits(cellCoordinate(position[i][axis] - low[axis], size)) << axis;
    keys_[i] = {hilbertPlace(code, levels), static_cast<std::int32_t>(i)};
  });
  radixSort(keys_, spareKeys_, radius.size(), 3 * levels);
}

void BallTree::boxClusters() {
  if (levels_.empty()) levels_.emplace_back();
  Boxes& boxes = levels_[0];
  boxes.reserve(static_cast<std::size_t>(clusters()));
  boxes.count = static_cast<std::size_t>(clusters());
  const RawBuffer<double>* centre[3] = {&x_, &y_, &z_};
  forEachIndex(boxes.count, [&](std::size_t cluster) {
    const std::size_t begin = cluster * kFan, end = std::min(begin + kFan, order_.size());
    boxes.number[cluster] = static_cast<std::int32_t>(cluster);
    for (int axis = 0; axis < 3; ++axis) {
      double low = kInfinity, high = -kInfinity;
      for (std::size_t s = begin; s < end; ++s) {
        const double x = (*centre[axis])[s], far = far_[s] + kRoundOff * (std::abs(x) + far_[s]);
        low = std::min(low, x - far), high = std::max(high, x + far);
      }
      boxes.low[axis][cluster] = low, boxes.high[axis][cluster] = high;
    }
  });
  for (height_ = 1; levels_[height_ - 1].count > kFan; ++height_) {
    if (static_cast<std::int32_t>(levels_.size()) == height_) levels_.emplace_back();
    boxLevel(levels_[height_ - 1], levels_[height_]);
  }
}

void BallTree::boxLevel(const Boxes& finer, Boxes& coarser) const {
  coarser.count = (finer.count + kFan - 1) / kFan;
  coarser.reserve(coarser.count);
  for (std::size_t k = 0; k < coarser.count; ++k) {
    const Box box = boxAround(finer, k * kFan, std::min((k + 1) * kFan, finer.count));
    for (int axis = 0; axis < 3; ++axis)
      coarser.low[axis][k] = box.low[axis], coarser.high[axis][k] = box.high[axis];
  }
}

/// Finds the clusters from a group of eight on that those of the group may be near to, from the largest boxes
/// down and ascending: so those of the group itself come first.
void BallTree::openGroup(std::int32_t group, Query& query) const {
  const Boxes& clusterBoxes = levels_[0];
  const auto first = static_cast<std::size_t>(group) * kFan;
  const Box box = boxAround(clusterBoxes, first, std::min(first + kFan, clusterBoxes.count));
  query.group = group, query.around.count = 0;
  std::vector<std::int32_t>& stack = query.stack;
  stack.assign({0, height_ - 1});  // blocks of boxes, each by its number and level
  while (!stack.empty()) {
    const std::int32_t level = stack.back(), block = stack[stack.size() - 2];
    stack.resize(stack.size() - 2);
    const Boxes& boxes = levels_[level];
    const std::size_t begin = static_cast<std::size_t>(block) * kFan,
                      end = std::min(begin + kFan, boxes.count);
    if (level == 0) {
      addMeeting(boxes, begin, end, box, query.around);
      continue;
    }
    std::uint32_t met = 0;
    for (std::size_t k = begin; k < end; k += kLanes) met |= meets(boxes, k, box) << (k - begin);
    const auto own = static_cast<std::int32_t>(first >> kFanBits * level);  // box with the group
    for (; met != 0; met ^= std::bit_floor(met)) {                          // what is pushed last comes next
      const std::int32_t last = static_cast<std::int32_t>(begin) + std::bit_width(met) - 1;
      if (last < own) break;
      stack.push_back(last), stack.push_back(level - 1);
    }
  }
}

void BallTree::openCluster(std::int32_t cluster, Query& query) const {
  if (cluster / kFan != query.group) openGroup(cluster / kFan, query);
  query.open.count = 0;
  const auto k = static_cast<std::size_t>(cluster);
  addMeeting(query.around, k % kFan, query.around.count, boxAround(levels_[0], k, k + 1), query.open);
}

/// Lists the open clusters whose box is no farther from a ball's centre than it reaches: a third of them.
std::size_t BallTree::findClosest(std::int32_t s, Query& query) const {
  const double centre[3] = {x_[s], y_[s], z_[s]}, far2 = far_[s] * far_[s] * (1 + kRoundOff);
  if (query.closest.size() < query.open.count + kFan) query.closest.resize(2 * (query.open.count + kFan));
  std::size_t closest = 0;
  for (std::size_t k = 0; k < query.open.count; k += kLanes) {
    Lanes gap2 = {};
    for (int axis = 0; axis < 3; ++axis) {
      const Lanes below = loadLanes(&query.open.low[axis][k]) - centre[axis];
      const Lanes above = centre[axis] - loadLanes(&query.open.high[axis][k]);
      const Lanes out = below > above ? below : above, gap = out > 0 ? out : Lanes{};
      gap2 += gap * gap;
    }
    const std::uint32_t bits = bitsOf(gap2 < far2) & lanesBelow(query.open.count - k);
    closest += storeSelected(bits, &query.open.number[k], &query.closest[closest]);
  }
  return closest;
}

void BallTree::findLater(std::int32_t s, Query& query) const {
  const std::size_t closest = findClosest(s, query);
  std::size_t found = query.found;
  if (query.near.size() < found + (closest + 1) * kFan) query.near.resize(2 * (found + (closest + 1) * kFan));
  const double x = x_[s], y = y_[s], z = z_[s], far = far_[s], inward = 2 / reach_ - 1;
  const Lanes own = Lanes{} + far;
  const auto next = static_cast<std::size_t>(s) + 1;
  for (std::size_t c = 0; c < closest; ++c)
    for (std::size_t k = 0; k < kFan; k += kLanes) {
      const std::size_t t = static_cast<std::size_t>(query.closest[c]) * kFan + k;
      const Lanes dx = loadLanes(&x_[t]) - x, dy = loadLanes(&y_[t]) - y, dz = loadLanes(&z_[t]) - z,
                  other = loadLanes(&far_[t]), near = other + far, large = other > own ? other : own,
                  small = other > own ? own : other, inner = large * (1 + kTieSpare) - small * inward,
                  distance2 = dx * dx + dy * dy + dz * dz;
      std::uint32_t bits = bitsOf(distance2 < near * near);
      if (t < next) bits &= ~lanesBelow(next - t);
      for (std::uint32_t left = bits & bitsOf((inner > 0) & (distance2 <= inner * inner)); left != 0;
           left &= left - 1)
        noteNesting(s, static_cast<std::int32_t>(t) + std::countr_zero(left), query);
      found += storePlaces(bits, static_cast<std::int32_t>(t), &query.near[found]);
    }
  query.found = found;
}

/// Of two balls of which the smaller one may come to lie in the larger one, and the other way round if they
/// are all but the same.
void BallTree::noteNesting(std::int32_t s, std::int32_t t, Query& query) const {
  const double dx = x_[t] - x_[s], dy = y_[t] - y_[s], dz = z_[t] - z_[s],
               distance2 = dx * dx + dy * dy + dz * dz;
  for (const auto& [inner, outer] : {Nesting{s, t}, Nesting{t, s}}) {
    const double spare = far_[outer] * (1 + kTieSpare) - far_[inner] * (2 / reach_ - 1);
    if (spare > 0 && distance2 <= spare * spare) query.nestings.push_back({inner, outer});
  }
}

}  // namespace spume::foam
