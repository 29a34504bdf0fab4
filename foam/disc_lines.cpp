#include "foam/disc_lines.h"

#include <algorithm>

namespace spume::foam {

namespace {

constexpr double kFar = 1e100;  ///< stands for infinity where products are formed

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

void DiscLines::reserve(std::size_t discs, std::size_t planes) {
  discs_ = discs, stride_ = paddedToLanes(planes) + kLanes;  // closing gaps writes whole blocks
  if (const std::size_t room = paddedToLanes(discs); face_.size() < room) {
    face_.resize(room), gone_.resize(room), count_.resize(room);
    for (auto* column : {&frame_.nx, &frame_.ny, &frame_.nz, &frame_.height, &frame_.shift, &frame_.ux,
                         &frame_.uy, &frame_.uz, &frame_.vx, &frame_.vy, &frame_.vz, &frame_.radius2})
      column->resize(room);
  }
  if (ux_.size() >= discs * stride_) return;
  for (auto* column : {&ux_, &uy_, &offset_, &shift_, &half_}) column->resize(2 * discs * stride_);
}

/// Unit vectors u and v that make a right-handed frame with the normal, continuous but at nz = 0.
void DiscLines::frameDiscs(const CuttingPlanes& planes, double radius) {
  for (std::size_t disc = 0; disc < discs_; ++disc) {
    const std::size_t p = face_[disc];
    frame_.nx[disc] = planes.nx[p], frame_.ny[disc] = planes.ny[p], frame_.nz[disc] = planes.nz[p];
    frame_.height[disc] = planes.height[p], frame_.shift[disc] = planes.heightShift[p];
  }
  for (std::size_t k = 0; k < discs_; k += kLanes) {
    const Lanes x = loadLanes(&frame_.nx[k]), y = loadLanes(&frame_.ny[k]), z = loadLanes(&frame_.nz[k]);
    const Lanes one = Lanes{} + 1, sign = z < 0 ? -one : one, a = -1 / (sign + z), b = x * y * a;
    storeLanes(&frame_.ux[k], 1 + sign * x * x * a), storeLanes(&frame_.uy[k], sign * b);
    storeLanes(&frame_.uz[k], -sign * x), storeLanes(&frame_.vx[k], b);
    storeLanes(&frame_.vy[k], sign + y * y * a), storeLanes(&frame_.vz[k], -y);
    const Lanes height = loadLanes(&frame_.height[k]), radius2 = (radius - height) * (radius + height);
    storeLanes(&frame_.radius2[k], radius2);
    const std::uint32_t left = bitsOf(radius2 > 0);
    for (std::size_t l = 0; l < kLanes; ++l) gone_[k + l] = ~left >> l & 1, count_[k + l] = 0;
  }
}

void DiscLines::find(const CuttingPlanes& planes, std::span<const std::int32_t> faces, double radius) {
  reserve(faces.size(), planes.count);
  for (std::size_t disc = 0; disc < discs_; ++disc) face_[disc] = static_cast<std::size_t>(faces[disc]);
  frameDiscs(planes, radius);
  for (std::size_t k = 0; k < planes.count; k += kLanes) findInBlock(planes, k);
}

/// Finds the lines of a block of planes on all discs. A line at |D| < rho cuts the disc; a plane at D <= -rho
/// takes all of it.
void DiscLines::findInBlock(const CuttingPlanes& planes, std::size_t k) {
  const Lanes kx = loadLanes(&planes.nx[k]), ky = loadLanes(&planes.ny[k]), kz = loadLanes(&planes.nz[k]);
  const Lanes height = loadLanes(&planes.height[k]), shift = loadLanes(&planes.heightShift[k]);
  const std::uint32_t block = lanesBelow(planes.count - k);
  const Frames& on = frame_;
  double *const ux = ux_.data(), *const uy = uy_.data(), *const offset = offset_.data(),
                *const shifts = shift_.data();
  for (std::size_t disc = 0; disc < discs_; ++disc) {
    const Lanes px = kx * on.ux[disc] + ky * on.uy[disc] + kz * on.uz[disc];
    const Lanes py = kx * on.vx[disc] + ky * on.vy[disc] + kz * on.vz[disc];
    const Lanes along = kx * on.nx[disc] + ky * on.ny[disc] + kz * on.nz[disc];
    const Lanes toPlane = height - on.height[disc] * along, slope2 = px * px + py * py;
    const std::uint64_t own = std::uint64_t{1} << std::min<std::size_t>(face_[disc] - k, 63);
    const std::uint32_t others = block & ~static_cast<std::uint32_t>(own);
    const std::uint32_t cuts = bitsOf(toPlane * toPlane < on.radius2[disc] * slope2) & others;
    gone_[disc] |= bitsOf(toPlane < 0) & others & ~cuts;
    const std::size_t end = disc * stride_ + count_[disc];
    storeSelected(cuts, px, ux + end), storeSelected(cuts, py, uy + end);
    storeSelected(cuts, toPlane, offset + end);
    count_[disc] += storeSelected(cuts, shift - along * on.shift[disc], shifts + end);
  }
}

void DiscLines::scale() {
  double *const ux = ux_.data(), *const uy = uy_.data(), *const offset = offset_.data(),
                *const shift = shift_.data(), *const half = half_.data();
  for (std::size_t disc = 0; disc < discs_; ++disc) {
    if (gone_[disc] != 0) continue;
    const std::size_t begin = disc * stride_, end = begin + count_[disc];
    for (std::size_t k = begin; k < end; k += kLanes) {
      const Lanes px = loadLanes(ux + k), py = loadLanes(uy + k);
      const Lanes inverse = 1 / squareRoot(px * px + py * py), distance = loadLanes(offset + k) * inverse;
      const Lanes half2 = frame_.radius2[disc] - distance * distance;
      storeLanes(ux + k, px * inverse), storeLanes(uy + k, py * inverse);
      storeLanes(shift + k, loadLanes(shift + k) * inverse), storeLanes(offset + k, distance);
      storeLanes(half + k, squareRoot(half2 > 0 ? half2 : Lanes{}));
    }
  }
}

DiscLines::Rest DiscLines::clip(std::size_t disc, FilmEdges& edges) const {
  const std::size_t count = count_[disc], begin = disc * stride_, before = edges.count;
  if (count == 0) return {};
  edges.reserve(before + count);
  const double *const allUx = ux_.data() + begin, *const allUy = uy_.data() + begin,
                      *const allOffset = offset_.data() + begin;
  const Lanes none = Lanes{} + kFar;
  std::uint32_t beyond = 0, open = 0;
  for (std::size_t k = 0; k < count; k += kLanes) {
    const Lanes ux = loadLanes(allUx + k), uy = loadLanes(allUy + k), offset = loadLanes(allOffset + k);
    const Lanes half = loadLanes(&half_[begin + k]);
    Lanes t1 = -half, t2 = half;
    LaneMask toSelf = firstLanes() + static_cast<std::int64_t>(k);
    for (std::size_t l = 0; l < count; ++l, toSelf -= 1) {
      const double lx = allUx[l], ly = allUy[l], ld = allOffset[l];
      const Lanes slope = toSelf == 0 ? Lanes{} : ly * ux - lx * uy;
      const Lanes gap = toSelf == 0 ? Lanes{} : ld - offset * (lx * ux + ly * uy);
      const Lanes t = gap / slope;
      const Lanes parallel = ((slope == 0) & (gap < 0)) ? -none : none;
      const Lanes upper = slope > 0 ? t : parallel, lower = slope < 0 ? t : -none;
      t2 = t2 < upper ? t2 : upper;
      t1 = t1 > lower ? t1 : lower;
    }
    const std::uint32_t left = bitsOf(t2 > t1) & lanesBelow(count - k);
    open |= left & ~bitsOf((t1 > -half) & (t2 < half));
    beyond |= bitsOf(offset < 0) & lanesBelow(count - k);
    const std::size_t end = edges.count;
    storeSelected(left, offset, &edges.offset[end]), storeSelected(left, t1, &edges.t1[end]);
    storeSelected(left, loadLanes(&shift_[begin + k]), &edges.shift[end]);
    edges.count += storeSelected(left, t2, &edges.t2[end]);
  }
  return {edges.count > before, beyond == 0, open == 0};
}

}  // namespace spume::foam
