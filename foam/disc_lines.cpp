#include "foam/disc_lines.h"

#include <algorithm>

namespace spume::foam {

namespace {

constexpr double kFar = 1e100;  ///< stands for infinity where products are formed

/// Two unit vectors that make a right-handed frame with the unit vector (x, y, z), continuous but at z = 0.
struct PlaneFrame {
  double ux, uy, uz, vx, vy, vz;
  PlaneFrame(double x, double y, double z) {
    const double sign = z < 0 ? -1 : 1;
    const double a = -1 / (sign + z), b = x * y * a;
    ux = 1 + sign * x * x * a, uy = sign * b, uz = -sign * x;
    vx = b, vy = sign + y * y * a, vz = -y;
  }
};

LaneMask firstLanes() {
  LaneMask lanes;
  for (std::size_t k = 0; k < kLanes; ++k) lanes[k] = static_cast<std::int64_t>(k);
  return lanes;
}

}  // namespace

void CuttingPlanes::resize(std::size_t planes) {
  count = planes;
  if (const std::size_t padded = paddedToLanes(planes); nx.size() < padded)
    for (auto* column : {&nx, &ny, &nz, &height, &heightShift}) column->resize(padded);
}

void FilmEdges::reserve(std::size_t edges) {
  if (offset.size() >= edges + kLanes) return;
  for (auto* column : {&offset, &shift, &t1, &t2}) column->resize(2 * edges + kLanes);
}

void DiscLines::reserve(std::size_t lines) {
  const std::size_t room = paddedToLanes(lines) + kLanes;
  if (ux_.size() >= room) return;
  for (auto* column : {&ux_, &uy_, &offset_, &shift_, &slope2_, &half_}) column->resize(room);
}

/// A line at |D| < rho cuts the disc; a plane at D <= -rho takes all of it.
bool DiscLines::find(const CuttingPlanes& planes, std::size_t face, double radius) {
  const double nx = planes.nx[face], ny = planes.ny[face], nz = planes.nz[face], height = planes.height[face];
  const double shift = planes.heightShift[face];
  discRadius2_ = (radius - height) * (radius + height);
  if (!(discRadius2_ > 0)) return false;
  const PlaneFrame frame(nx, ny, nz);
  reserve(planes.count);
  count_ = 0;
  for (std::size_t k = 0; k < planes.count; k += kLanes) {
    const Lanes kx = loadLanes(&planes.nx[k]), ky = loadLanes(&planes.ny[k]), kz = loadLanes(&planes.nz[k]);
    const Lanes px = kx * frame.ux + ky * frame.uy + kz * frame.uz;
    const Lanes py = kx * frame.vx + ky * frame.vy + kz * frame.vz;
    const Lanes along = kx * nx + ky * ny + kz * nz, slope2 = px * px + py * py;
    const Lanes toPlane = loadLanes(&planes.height[k]) - height * along;
    std::uint32_t others = lanesBelow(planes.count - k);
    if (face - k < kLanes) others &= ~(1u << (face - k));
    const std::uint32_t cuts = bitsOf(toPlane * toPlane < discRadius2_ * slope2) & others;
    if (bitsOf(toPlane < 0) & others & ~cuts) return false;
    storeSelected(cuts, px, &ux_[count_]), storeSelected(cuts, py, &uy_[count_]);
    storeSelected(cuts, toPlane, &offset_[count_]), storeSelected(cuts, slope2, &slope2_[count_]);
    count_ += storeSelected(cuts, loadLanes(&planes.heightShift[k]) - along * shift, &shift_[count_]);
  }
  return true;
}

void DiscLines::scale() {
  for (std::size_t k = 0; k < count_; k += kLanes) {
    const Lanes inverse = 1 / squareRoot(loadLanes(&slope2_[k]));
    for (auto* column : {&ux_, &uy_, &shift_}) storeLanes(&(*column)[k], loadLanes(&(*column)[k]) * inverse);
    const Lanes offset = loadLanes(&offset_[k]) * inverse, half2 = discRadius2_ - offset * offset;
    storeLanes(&offset_[k], offset), storeLanes(&half_[k], squareRoot(half2 > 0 ? half2 : Lanes{}));
  }
}

DiscLines::Rest DiscLines::clip(FilmEdges& edges) const {
  if (count_ == 0) return {};
  edges.reserve(edges.count + count_);
  const std::size_t before = edges.count;
  const Lanes none = Lanes{} + kFar;
  std::uint32_t beyond = 0, open = 0;
  for (std::size_t k = 0; k < count_; k += kLanes) {
    const Lanes ux = loadLanes(&ux_[k]), uy = loadLanes(&uy_[k]), offset = loadLanes(&offset_[k]);
    const Lanes half = loadLanes(&half_[k]);
    Lanes t1 = -half, t2 = half;
    LaneMask toSelf = firstLanes() + static_cast<std::int64_t>(k);
    for (std::size_t l = 0; l < count_; ++l, toSelf -= 1) {
      const double lx = ux_[l], ly = uy_[l], ld = offset_[l];
      const Lanes slope = toSelf == 0 ? Lanes{} : ly * ux - lx * uy;
      const Lanes gap = toSelf == 0 ? Lanes{} : ld - offset * (lx * ux + ly * uy);
      const Lanes t = gap / slope;
      const Lanes parallel = ((slope == 0) & (gap < 0)) ? -none : none;
      const Lanes upper = slope > 0 ? t : parallel, lower = slope < 0 ? t : -none;
      t2 = t2 < upper ? t2 : upper;
      t1 = t1 > lower ? t1 : lower;
    }
    const std::uint32_t left = bitsOf(t2 > t1) & lanesBelow(count_ - k);
    open |= left & ~bitsOf((t1 > -half) & (t2 < half));
    beyond |= bitsOf(offset < 0) & lanesBelow(count_ - k);
    const std::size_t end = edges.count;
    storeSelected(left, offset, &edges.offset[end]), storeSelected(left, t1, &edges.t1[end]);
    storeSelected(left, loadLanes(&shift_[k]), &edges.shift[end]);
    edges.count += storeSelected(left, t2, &edges.t2[end]);
  }
  return {edges.count > before, beyond == 0, open == 0};
}

}  // namespace spume::foam
