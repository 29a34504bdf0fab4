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
    x_[c] = half * (2 * up[0] - 1), y_[c] = half * (2 * up[1] - 1), z_[c] = half * (2 * up[2] - 1);
    const bool turned = (up[0] + up[1] + up[2]) % 2 == 0;
    const int axis[3] = {0, turned ? 2 : 1, turned ? 1 : 2};
    for (std::size_t e = 0; e < 3; ++e) {
      const int along = axis[after(after(e))], back = along == 0 ? 1 : (along == 1) == turned ? 2 : 0;
      corner_[c].face[e] = 2 * axis[e] + up[axis[e]];
      corner_[c].next[e] = 4 * (c ^ (1 << along)) + back;
    }
  }
  pad();
  box_.low.setConstant(-half), box_.high.setConstant(half);
  boxIsOld_ = false;
}

void ConvexCell::makeRoom(std::size_t corners) {
  if (corner_.size() >= corners) return;
  const std::size_t room = 2 * paddedToLanes(corners);
  corner_.resize(room), lost_.resize(room), crossing_.resize(3 * room);
  for (auto* column : {&x_, &y_, &z_, &beyond_}) column->resize(room);
}

void ConvexCell::pad() {
  for (std::size_t k = count_; k < paddedToLanes(count_); ++k) x_[k] = x_[0], y_[k] = y_[0], z_[k] = z_[0];
}

ConvexCell::Cut ConvexCell::cut(const Eigen::Vector3d& normal, double offset, std::int32_t face) {
  const double touch = kTouch * half_ * normal.norm(), farthest = measure(normal, offset);
  if (farthest <= -touch) return Cut::missed;
  if (farthest <= touch) return Cut::unsure;
  if (!listLost()) return Cut::gone;
  findCrossings();
  if (!formRing()) return Cut::unsure;
  replaceCorners(face);
  lastFace_ = std::max(lastFace_, face);
  pad();
  boxIsOld_ = true;
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

/// False if no corner is left.
bool ConvexCell::listLost() {
  lostCount_ = 0;
  for (std::size_t k = 0; k < count_; ++k) {
    lost_[lostCount_] = static_cast<std::int32_t>(k);
    lostCount_ += beyond_[k] > 0;
  }
  return lostCount_ < count_;
}

void ConvexCell::findCrossings() {
  crossings_ = 0;
  for (std::size_t k = 0; k < lostCount_; ++k) {
    const std::int32_t v = lost_[k];
    const Corner& corner = corner_[v];
    for (std::size_t e = 0; e < 3; ++e) {
      const std::int32_t back = corner.next[e], u = back / 4;
      if (beyond_[u] > 0) continue;
      const double share = beyond_[v] / (beyond_[v] - beyond_[u]);
      crossing_[crossings_++] = {back,
                                 corner.face[e],
                                 corner.face[after(e)],
                                 -1,
                                 x_[v] + share * (x_[u] - x_[v]),
                                 y_[v] + share * (y_[u] - y_[v]),
                                 z_[v] + share * (z_[u] - z_[v])};
    }
  }
}

/// Orders the crossings to one ring around the new face; false if round-off has left anything else.
bool ConvexCell::formRing() {
  const auto crossings = static_cast<std::int32_t>(crossings_);
  if (crossings < 3) return false;
  if (crossingAt_.size() <= static_cast<std::size_t>(lastFace_)) crossingAt_.resize(2 * lastFace_ + 2, 0);
  for (std::int32_t k = 0; k < crossings; ++k) crossingAt_[crossing_[k].left] = k;
  for (std::int32_t k = 0; k < crossings; ++k) {
    const std::int32_t to = crossingAt_[crossing_[k].right];  // an earlier plane's where this one has none
    if (to >= crossings || crossing_[to].left != crossing_[k].right) return false;
    crossing_[k].after = to;
  }
  std::int32_t steps = 0;
  for (std::int32_t at = 0; (steps == 0 || at != 0) && steps <= crossings; ++steps) at = crossing_[at].after;
  return steps == crossings;
}

/// Puts the new corners in the places of the lost ones.
void ConvexCell::replaceCorners(std::int32_t face) {
  const std::size_t lost = lostCount_;
  makeRoom(count_ + crossings_);
  while (lostCount_ < crossings_) lost_[lostCount_++] = static_cast<std::int32_t>(count_++);
  for (std::size_t k = 0; k < crossings_; ++k) {
    const Crossing& crossing = crossing_[k];
    const std::int32_t c = lost_[k], next = lost_[crossing.after];
    corner_[c].face = {crossing.left, crossing.right, face};
    corner_[c].next[0] = crossing.back, corner_[c].next[1] = 4 * next + 2;
    corner_[next].next[2] = 4 * c + 1;
    corner_[crossing.back / 4].next[crossing.back % 4] = 4 * c;
    x_[c] = crossing.x, y_[c] = crossing.y, z_[c] = crossing.z;
  }
  if (crossings_ < lost) fillGaps(crossings_);
}

/// Moves the last corners to where lost ones have not been replaced: lost_ from `used` on, ascending.
void ConvexCell::fillGaps(std::size_t used) {
  for (std::size_t k = lostCount_; k-- > used;) {
    const std::int32_t gap = lost_[k], last = static_cast<std::int32_t>(--count_);
    if (gap == last) continue;
    corner_[gap] = corner_[last];
    x_[gap] = x_[last], y_[gap] = y_[last], z_[gap] = z_[last];
    for (std::int32_t e = 0; e < 3; ++e) {
      const std::int32_t other = corner_[gap].next[e];
      corner_[other / 4].next[other % 4] = 4 * gap + e;
    }
  }
}

void ConvexCell::findBox() {
  Lanes lowX = loadLanes(&x_[0]), lowY = loadLanes(&y_[0]), lowZ = loadLanes(&z_[0]);
  Lanes highX = lowX, highY = lowY, highZ = lowZ;
  for (std::size_t k = kLanes; k < count_; k += kLanes) {
    const Lanes x = loadLanes(&x_[k]), y = loadLanes(&y_[k]), z = loadLanes(&z_[k]);
    lowX = smaller(lowX, x), lowY = smaller(lowY, y), lowZ = smaller(lowZ, z);
    highX = larger(highX, x), highY = larger(highY, y), highZ = larger(highZ, z);
  }
  box_.low = {-largestOf(-lowX), -largestOf(-lowY), -largestOf(-lowZ)};
  box_.high = {largestOf(highX), largestOf(highY), largestOf(highZ)};
  boxIsOld_ = false;
}

void ConvexCell::listFaces(double radius2, std::vector<Face>& faces) {
  constexpr std::uint8_t kAny = 1, kWithin = 2;
  corners_.assign(static_cast<std::size_t>(lastFace_) + 1, 0);
  for (std::size_t k = 0; k < count_; ++k) {
    const bool within = x_[k] * x_[k] + y_[k] * y_[k] + z_[k] * z_[k] < radius2;
    for (const std::int32_t face : corner_[k].face) corners_[face] |= within ? kAny | kWithin : kAny;
  }
  faces.clear();
  for (std::int32_t face = kCubeFaces; face <= lastFace_; ++face)
    if (corners_[face] != 0) faces.push_back({face, (corners_[face] & kWithin) != 0});
}

}  // namespace spume::foam
