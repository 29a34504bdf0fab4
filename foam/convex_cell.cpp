#include "foam/convex_cell.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "foam/lane_math.h"

namespace spume::foam {

namespace {

/// Corners nearer to a plane than this share of the cube count as on it: above round-off, far below the
/// tie-breaking jitter.
constexpr double kTouch = 1e-13;

std::size_t after(std::size_t edge) { return edge == 2 ? 0 : edge + 1; }

Lanes larger(const Lanes& a, const Lanes& b) { return a > b ? a : b; }
Lanes smaller(const Lanes& a, const Lanes& b) { return a < b ? a : b; }

double largestOf(const Lanes& x) {
  double largest = x[0];
  for (std::size_t k = 1; k < kLanes; ++k) largest = std::max(largest, x[k]);
  return largest;
}

}  // namespace

void ConvexCell::reset(double half) {
  constexpr std::int32_t kCubeCorners = 8;
  half_ = half, lastFace_ = kCubeFaces - 1;
  count_ = kCubeCorners;
  makeRoom(count_);
  for (std::int32_t c = 0; c < kCubeCorners; ++c) {
    const int up[3] = {c & 1, c >> 1 & 1, c >> 2 & 1};
    setPlace(c, half * Eigen::Vector3d(2 * up[0] - 1, 2 * up[1] - 1, 2 * up[2] - 1));
    const bool turned = (up[0] + up[1] + up[2]) % 2 == 0;
    const int axis[3] = {0, turned ? 2 : 1, turned ? 1 : 2};
    for (std::size_t e = 0; e < 3; ++e) {
      corner_[c].face[e] = 2 * axis[e] + up[axis[e]];
      corner_[c].next[e] = c ^ (1 << axis[after(after(e))]);
    }
  }
  pad();
  low_.setConstant(-half), high_.setConstant(half);
  farthest_ = std::sqrt(3.0) * half;
}

void ConvexCell::makeRoom(std::size_t corners) {
  if (corner_.size() >= corners) return;
  const std::size_t room = 2 * paddedToLanes(corners);
  corner_.resize(room);
  for (auto* column : {&x_, &y_, &z_, &beyond_}) column->resize(room);
}

void ConvexCell::pad() {
  for (std::size_t k = count_; k < paddedToLanes(count_); ++k) x_[k] = x_[0], y_[k] = y_[0], z_[k] = z_[0];
}

ConvexCell::Cut ConvexCell::cut(const Eigen::Vector3d& normal, double offset, std::int32_t face) {
  const double touch = kTouch * half_ * normal.norm(), farthest = measure(normal, offset);
  if (farthest <= -touch) return Cut::missed;
  if (farthest <= touch) return Cut::unsure;
  lost_.resize(count_);
  std::size_t lost = 0;
  for (std::size_t k = 0; k < count_; ++k) {
    lost_[lost] = static_cast<std::int32_t>(k);
    lost += beyond_[k] > 0;
  }
  if (lost == count_) return Cut::gone;
  lost_.resize(lost);
  findCrossings();
  if (!formRing()) return Cut::unsure;
  replaceCorners(face);
  lastFace_ = std::max(lastFace_, face);
  pad();
  findBounds();
  return Cut::done;
}

/// Sets beyond_ and returns the largest.
double ConvexCell::measure(const Eigen::Vector3d& normal, double offset) {
  Lanes most = Lanes{} - std::numeric_limits<double>::max();
  for (std::size_t k = 0; k < count_; k += kLanes) {
    const Lanes beyond = loadLanes(&x_[k]) * normal.x() + loadLanes(&y_[k]) * normal.y() +
                         loadLanes(&z_[k]) * normal.z() - offset;
    storeLanes(&beyond_[k], beyond);
    most = larger(most, beyond);
  }
  return largestOf(most);
}

void ConvexCell::findCrossings() {
  crossing_.clear();
  for (const std::int32_t v : lost_)
    for (std::size_t e = 0; e < 3; ++e) {
      const std::int32_t u = corner_[v].next[e], left = corner_[v].face[e], right = corner_[v].face[after(e)];
      if (beyond_[u] > 0) continue;
      std::int32_t back = 0;
      while (back < 2 && corner_[u].face[back] != right) ++back;
      const double share = beyond_[v] / (beyond_[v] - beyond_[u]);
      crossing_.push_back({v, u, back, left, right, -1, place(v) + share * (place(u) - place(v))});
    }
}

/// Orders the crossings to one ring around the new face; false if round-off has left anything else.
bool ConvexCell::formRing() {
  const auto crossings = static_cast<std::int32_t>(crossing_.size());
  if (crossings < 3) return false;
  if (crossingAt_.size() <= static_cast<std::size_t>(lastFace_)) crossingAt_.resize(2 * lastFace_ + 2, 0);
  for (std::int32_t k = 0; k < crossings; ++k) crossingAt_[crossing_[k].left] = k;
  for (Crossing& from : crossing_) {
    const std::int32_t to = crossingAt_[from.right];  // from an earlier plane where this one has none
    if (to >= crossings || crossing_[to].left != from.right) return false;
    from.after = to;
  }
  std::int32_t steps = 0;
  for (std::int32_t at = 0; (steps == 0 || at != 0) && steps <= crossings; ++steps) at = crossing_[at].after;
  return steps == crossings;
}

/// Puts the new corners in the places of the lost ones.
void ConvexCell::replaceCorners(std::int32_t face) {
  while (lost_.size() < crossing_.size()) lost_.push_back(static_cast<std::int32_t>(count_++));
  makeRoom(count_);
  for (std::size_t k = 0; k < crossing_.size(); ++k) {
    const Crossing& crossing = crossing_[k];
    Corner& corner = corner_[lost_[k]];
    corner.face = {crossing.left, crossing.right, face};
    corner.next[0] = crossing.stays, corner.next[1] = lost_[crossing.after];
    corner_[lost_[crossing.after]].next[2] = lost_[k];
    corner_[crossing.stays].next[crossing.back] = lost_[k];
    setPlace(static_cast<std::size_t>(lost_[k]), crossing.place);
  }
  fillGaps(crossing_.size());
}

/// Moves the last corners to where lost ones have not been replaced: lost_ from `used` on, ascending.
void ConvexCell::fillGaps(std::size_t used) {
  for (std::size_t k = lost_.size(); k-- > used;) {
    const std::int32_t gap = lost_[k], last = static_cast<std::int32_t>(--count_);
    if (gap == last) continue;
    corner_[gap] = corner_[last];
    setPlace(static_cast<std::size_t>(gap), place(last));
    for (std::size_t e = 0; e < 3; ++e) {
      Corner& neighbour = corner_[corner_[gap].next[e]];
      for (std::size_t back = 0; back < 3; ++back)
        if (neighbour.next[back] == last && neighbour.face[back] == corner_[gap].face[after(e)])
          neighbour.next[back] = gap;
    }
  }
}

void ConvexCell::findBounds() {
  const Lanes zero = {};
  Lanes lowX = loadLanes(&x_[0]), lowY = loadLanes(&y_[0]), lowZ = loadLanes(&z_[0]);
  Lanes highX = lowX, highY = lowY, highZ = lowZ, far2 = zero;
  for (std::size_t k = 0; k < count_; k += kLanes) {
    const Lanes x = loadLanes(&x_[k]), y = loadLanes(&y_[k]), z = loadLanes(&z_[k]);
    lowX = smaller(lowX, x), lowY = smaller(lowY, y), lowZ = smaller(lowZ, z);
    highX = larger(highX, x), highY = larger(highY, y), highZ = larger(highZ, z);
    far2 = larger(far2, x * x + y * y + z * z);
  }
  low_ = {-largestOf(-lowX), -largestOf(-lowY), -largestOf(-lowZ)};
  high_ = {largestOf(highX), largestOf(highY), largestOf(highZ)};
  farthest_ = std::sqrt(largestOf(far2));
}

void ConvexCell::listFaces(std::vector<std::int32_t>& faces) {
  isLeft_.assign(static_cast<std::size_t>(lastFace_) + 1, 0);
  for (std::size_t k = 0; k < count_; ++k)
    for (const std::int32_t face : corner_[k].face) isLeft_[face] = 1;
  faces.clear();
  for (std::int32_t face = kCubeFaces; face <= lastFace_; ++face)
    if (isLeft_[face]) faces.push_back(face);
}

}  // namespace spume::foam
