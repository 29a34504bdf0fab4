#include "foam/inflated_cell.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "foam/lane_math.h"
#include "foam/short_sort.h"

namespace spume::foam {

namespace {

using Eigen::Vector3d;

/// Nearness of a site at the bubble's own place: before all others.
constexpr double kFirst = -1e300;

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

/// Planes no higher than this many radii are those of bubbles that touch, or nearly.
constexpr double kTouching = 1.5;

/// From so many sites on, looking at them twice costs less than cutting by them all.
constexpr std::size_t kMany = 48;

/// A corner counts as inside the ball if it is by this share of r^2: well above round-off.
constexpr double kInside = 1e-12;

/// The most that a site's distance d along one axis, from `nearest` to `farthest` [m] on one side, adds to
/// how far its plane cuts into a cell that ends at `end` on that side: d end - d^2/2. None if there is no
/// such d.
double mostGain(double end, double nearest, double farthest) {
  if (farthest < nearest) return -std::numeric_limits<double>::infinity();
  const double d = std::clamp(end, nearest, farthest);
  return d * (end - d / 2);
}

/// How far outside its cell of the grid a site at x might be [m]: round-off of its cell's number, which far
/// out says nothing.
double marginOf(double x, double size) {
  constexpr double kFar = 0x1p40, kSlack = 1e-3;
  return std::abs(x) < kFar * size ? kSlack * size : std::numeric_limits<double>::max() / 8;
}

/// Sorts by nearness, and where single precision does not tell, by place.
std::int64_t candidateOf(double nearness, std::size_t place) {
  const auto bits = std::bit_cast<std::int32_t>(static_cast<float>(nearness));
  const std::int64_t ascending = bits ^ (bits >> 31 & std::numeric_limits<std::int32_t>::max());
  return ascending << 32 | static_cast<std::int64_t>(place);
}

std::int32_t placeOf(std::int64_t candidate) { return static_cast<std::int32_t>(candidate); }

}  // namespace

bool InflatedCell::build(std::int32_t s, double inflation, Vicinity& vicinity) {
  grid_ = &vicinity.grid(), number_ = s, site_ = &grid_->sites()[s];
  reach_ = std::sqrt(site_->ball.radius * site_->ball.radius + inflation);
  face_.clear(), unsure_.clear();
  hasPlanes_ = false;
  cell_.reset(reach_);
  if (!grow(vicinity)) return false;
  listNeighbours();
  return true;
}

/// Cuts the polyhedron by all sites that can; false if one takes all of it.
bool InflatedCell::grow(Vicinity& vicinity) {
  std::size_t begin = 0, end = vicinity.keepNearest();
  for (std::int64_t ring = 1;; ++ring) {
    if (!cutByNearest(vicinity, begin, end)) return false;
    // All sites that are nearer along every axis have been visited.
    const double seen = static_cast<double>(ring) * grid_->cellSize();
    if (noneBeyond(seen) || grid_->endsWithin(site_->position, ring)) return true;
    weighRing(ring + 1);
    begin = end, end = vicinity.addRing(ring + 1, worth_);
  }
}

/// How far sites can cut into the box around the cell, by their grid cells as far as that ring.
void InflatedCell::weighRing(std::int64_t ring) {
  const ConvexCell::Box& box = cell_.box();
  const double r = site_->ball.radius, largest = grid_->maxRadius(), size = grid_->cellSize();
  const Vector3d corner = grid_->cornerOf(site_->position) - site_->position;
  worth_.least = -(largest - r) * (largest + r) / 2 - kInside * reach_ * reach_;
  for (int axis = 0; axis < 3; ++axis) {
    const double margin = marginOf(site_->position[axis], size), top = box.high[axis],
                 bottom = -box.low[axis];
    worth_.along[axis].clear();
    for (std::int64_t k = -ring; k <= ring; ++k) {
      const double low = corner[axis] + static_cast<double>(k) * size - margin,
                   high = low + size + 2 * margin;
      worth_.along[axis].push_back(
          std::max(mostGain(top, std::max(low, 0.0), high), mostGain(bottom, std::max(-high, 0.0), -low)));
    }
  }
}

/// Whether no site at `seen` or more along any axis [m] can cut the cell. The plane of a site at d cuts it
/// if d . p > (d^2 + r^2 - R^2)/2 for a point p of the cell; p is taken from the box around it.
bool InflatedCell::noneBeyond(double seen) {
  const double r = site_->ball.radius, largest = grid_->maxRadius();
  const double radii = (largest - r) * (largest + r) / 2;
  if (seen / 2 - radii / seen >= reach_) return true;  // no plane meets the ball
  const ConvexCell::Box& box = cell_.box();
  double near[3], far[3];
  for (int axis = 0; axis < 3; ++axis) {
    const double up = grid_->high()[axis] - site_->position[axis], top = box.high[axis];
    const double down = site_->position[axis] - grid_->low()[axis], bottom = -box.low[axis];
    near[axis] = std::max(mostGain(top, 0, up), mostGain(bottom, 0, down));
    far[axis] = std::max(mostGain(top, seen, up), mostGain(bottom, seen, down));
  }
  return std::max({far[0] + near[1] + near[2], near[0] + far[1] + near[2], near[0] + near[1] + far[2]}) <=
         -radii;
}

/// Cuts by sites begin .. end - 1 of the vicinity, from the nearest plane on.
bool InflatedCell::cutByNearest(const Vicinity& vicinity, std::size_t begin, std::size_t end) {
  if (begin > 0 || end < kMany) return cutByHeights(vicinity, begin, end, -kNoLimit, kNoLimit);
  // While the cell is still the whole cube, no site can be left out: the few nearest make it small.
  const double touching = kTouching * site_->ball.radius, low = touching * touching;
  return cutByHeights(vicinity, begin, end, -kNoLimit, low) &&
         cutByHeights(vicinity, begin, end, low, kNoLimit);
}

/// The same by those sites whose nearness is above `from` and at most `to` [m^2].
bool InflatedCell::cutByHeights(const Vicinity& vicinity, std::size_t begin, std::size_t end, double from,
                                double to) {
  count_ = 0;
  if (candidates_.size() < end - begin) candidates_.resize(2 * (end - begin));
  for (std::size_t k = begin; k < end; k += kLanes)
    addCandidates(vicinity, k, std::min(end, k + kLanes), from, to);
  sortShort(candidates_, count_, sorted_);
  for (const std::int64_t candidate : sorted_)
    if (!cutBy(vicinity, placeOf(candidate))) return false;
  return true;
}

/// Those of a block of sites whose plane meets the box around the polyhedron.
void InflatedCell::addCandidates(const Vicinity& vicinity, std::size_t k, std::size_t end, double from,
                                 double to) {
  const Lanes dx = loadLanes(&vicinity.x[k]) - site_->position.x(),
              dy = loadLanes(&vicinity.y[k]) - site_->position.y(),
              dz = loadLanes(&vicinity.z[k]) - site_->position.z(), radius = loadLanes(&vicinity.radius[k]);
  const double r = site_->ball.radius;
  const Lanes d2 = dx * dx + dy * dy + dz * dz, offset = (d2 + (r - radius) * (r + radius)) / 2;
  const ConvexCell::Box& box = cell_.box();
  const auto most = [&](const Lanes& d, int axis) { return d > 0 ? d * box.high[axis] : d * box.low[axis]; };
  const Lanes first = Lanes{} + kFirst, height2 = (offset < 0 ? -offset : offset) * offset / d2;
  const Lanes nearness = (d2 > 0) & (height2 > kFirst) ? height2 : first;
  const LaneMask meets =
      ((most(dx, 0) + most(dy, 1) + most(dz, 2) > offset) | (d2 == 0)) & (nearness > from) & (nearness <= to);
  for (std::uint32_t bits = bitsOf(meets); bits != 0; bits &= bits - 1) {
    const auto lane = static_cast<std::size_t>(std::countr_zero(bits));
    if (k + lane < end) candidates_[count_++] = candidateOf(nearness[lane], k + lane);
  }
}

bool InflatedCell::cutBy(const Vicinity& vicinity, std::int32_t place) {
  const std::int32_t s = vicinity.site[place];
  if (s == number_) return true;
  const Vector3d to = Vector3d(vicinity.x[place], vicinity.y[place], vicinity.z[place]) - site_->position;
  const double d2 = to.squaredNorm(), r = site_->ball.radius, radius = vicinity.radius[place];
  if (d2 == 0) return std::make_pair(radius, site_->index) <= std::make_pair(r, grid_->sites()[s].index);
  const double offset = (d2 + (r - radius) * (r + radius)) / 2;
  if (offset > 0 && offset * offset >= d2 * reach_ * reach_) return true;
  const auto number = static_cast<std::int32_t>(face_.size());
  const ConvexCell::Cut cut = cell_.cut(to, offset, ConvexCell::kCubeFaces + number);
  if (cut == ConvexCell::Cut::done || cut == ConvexCell::Cut::unsure) face_.push_back({s, d2});
  if (cut == ConvexCell::Cut::unsure) unsure_.push_back(ConvexCell::kCubeFaces + number);
  return cut != ConvexCell::Cut::gone;
}

void InflatedCell::listNeighbours() {
  cell_.listFaces(reach_ * reach_ - kInside * site_->ball.radius * site_->ball.radius, left_);
  for (const std::int32_t number : unsure_) left_.push_back({number, false});
  neighbours_.clear();
  for (const ConvexCell::Face& face : left_)
    neighbours_.push_back(face_[face.number - ConvexCell::kCubeFaces]);
}

bool InflatedCell::sharesFace(std::size_t k) {
  if (left_[k].cornerWithin) return true;
  if (!hasPlanes_) collectPlanes();
  const auto face = static_cast<std::int32_t>(k);
  disc_.find(planes_, {&face, 1}, reach_);
  if (!disc_.isLeft(0)) return false;
  disc_.scale();
  edges_.count = 0;
  return disc_.clip(0, edges_).any;
}

/// The planes of all faces that are left, for the discs.
void InflatedCell::collectPlanes() {
  planes_.resize(neighbours_.size());
  for (std::size_t k = 0; k < neighbours_.size(); ++k) {
    const SiteGrid::Site& other = grid_->sites()[neighbours_[k].site];
    const double d = std::sqrt(neighbours_[k].distance2);
    const Vector3d normal = (other.position - site_->position) / d;
    planes_.nx[k] = normal.x(), planes_.ny[k] = normal.y(), planes_.nz[k] = normal.z();
    planes_.height[k] = radicalHeight(site_->ball, other.ball, d), planes_.heightShift[k] = 0;
  }
  hasPlanes_ = true;
}

}  // namespace spume::foam
