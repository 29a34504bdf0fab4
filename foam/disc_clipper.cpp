#include "foam/disc_clipper.h"

#include <algorithm>
#include <limits>

namespace spume::foam {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kFar = 1e100;  ///< stands for infinity where products are formed

constexpr double kAngleRoundOff = 1e-15;  ///< of one edge's angle, a few ulp of pi

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

/// Room for a block of lanes after the last line: closing gaps writes whole blocks.
void DiscClipper::Lines::reserve(std::size_t lines) {
  const std::size_t room = paddedToLanes(lines) + kLanes;
  if (ux.size() >= room) return;
  for (auto* column : {&ux, &uy, &offset, &slope2, &shift, &half, &t1, &t2}) column->resize(room);
}

FilmShape DiscClipper::clip(const CuttingPlanes& planes, std::size_t face, const DiscBalls& balls) {
  FilmShape out;
  const double height = planes.height[face];
  const double discRadius2 = (balls.radius - height) * (balls.radius + height);
  if (!(discRadius2 > 0) || !findLines(planes, face, discRadius2) || !clipLines(discRadius2)) return out;
  out.empty = false;
  integrate(height, planes.heightShift[face], discRadius2, balls, out);
  return out;
}

bool DiscClipper::leavesAny(const CuttingPlanes& planes, std::size_t face, double radius) {
  const double height = planes.height[face], discRadius2 = (radius - height) * (radius + height);
  return discRadius2 > 0 && findLines(planes, face, discRadius2) && clipLines(discRadius2);
}

/// Collects the lines that cut the disc, at |D| < rho; false if one at D <= -rho takes all of it.
bool DiscClipper::findLines(const CuttingPlanes& planes, std::size_t face, double discRadius2) {
  const double nx = planes.nx[face], ny = planes.ny[face], nz = planes.nz[face], height = planes.height[face];
  const double shift = planes.heightShift[face];
  const PlaneFrame frame(nx, ny, nz);
  lines_.reserve(planes.count);
  std::size_t m = 0;
  for (std::size_t k = 0; k < planes.count; k += kLanes) {
    const Lanes kx = loadLanes(&planes.nx[k]), ky = loadLanes(&planes.ny[k]), kz = loadLanes(&planes.nz[k]);
    const Lanes px = kx * frame.ux + ky * frame.uy + kz * frame.uz;
    const Lanes py = kx * frame.vx + ky * frame.vy + kz * frame.vz;
    const Lanes along = kx * nx + ky * ny + kz * nz, slope2 = px * px + py * py;
    const Lanes toPlane = loadLanes(&planes.height[k]) - height * along;
    std::uint32_t others = lanesBelow(planes.count - k);
    if (face - k < kLanes) others &= ~(1u << (face - k));
    const std::uint32_t cuts = bitsOf(toPlane * toPlane < discRadius2 * slope2) & others;
    if (bitsOf(toPlane < 0) & others & ~cuts) return false;
    storeSelected(cuts, px, &lines_.ux[m]), storeSelected(cuts, py, &lines_.uy[m]);
    storeSelected(cuts, toPlane, &lines_.offset[m]), storeSelected(cuts, slope2, &lines_.slope2[m]);
    m += storeSelected(cuts, loadLanes(&planes.heightShift[k]) - along * shift, &lines_.shift[m]);
  }
  lines_.count = m;
  return true;
}

/// Cuts each line by the disc and all other lines; false if lines cut the disc and nothing is left.
bool DiscClipper::clipLines(double discRadius2) {
  centreInside_ = true, closed_ = false;
  if (lines_.count == 0) return true;
  scaleLines(discRadius2);
  for (std::size_t k = 0; k < lines_.count; k += kLanes) {
    const Lanes ux = loadLanes(&lines_.ux[k]), uy = loadLanes(&lines_.uy[k]),
                offset = loadLanes(&lines_.offset[k]);
    Lanes t1 = loadLanes(&lines_.t1[k]), t2 = loadLanes(&lines_.t2[k]);
    const Lanes none = Lanes{} + kFar;
    LaneMask toSelf = firstLanes() + static_cast<std::int64_t>(k);
    for (std::size_t l = 0; l < lines_.count; ++l, toSelf -= 1) {
      const double lx = lines_.ux[l], ly = lines_.uy[l], ld = lines_.offset[l];
      const Lanes slope = toSelf == 0 ? Lanes{} : ly * ux - lx * uy;
      const Lanes gap = toSelf == 0 ? Lanes{} : ld - offset * (lx * ux + ly * uy);
      const Lanes t = gap / slope;
      const Lanes parallel = ((slope == 0) & (gap < 0)) ? -none : none;
      const Lanes upper = slope > 0 ? t : parallel, lower = slope < 0 ? t : -none;
      t2 = t2 < upper ? t2 : upper;
      t1 = t1 > lower ? t1 : lower;
    }
    storeLanes(&lines_.t1[k], t1), storeLanes(&lines_.t2[k], t2);
  }
  keepEdges();
  return lines_.count > 0;
}

/// Drops the lines of which nothing bounds the film: about half of them. Padded lines are empty.
void DiscClipper::keepEdges() {
  std::size_t kept = 0;
  std::uint32_t beyond = 0, open = 0;
  for (std::size_t k = 0; k < lines_.count; k += kLanes) {
    const Lanes t1 = loadLanes(&lines_.t1[k]), t2 = loadLanes(&lines_.t2[k]),
                half = loadLanes(&lines_.half[k]);
    const std::uint32_t left = bitsOf(t2 > t1) & lanesBelow(lines_.count - k);
    open |= left & ~bitsOf((t1 > -half) & (t2 < half));
    beyond |= bitsOf(loadLanes(&lines_.offset[k]) < 0) & lanesBelow(lines_.count - k);
    for (auto* column : {&lines_.offset, &lines_.shift})
      storeSelected(left, loadLanes(&(*column)[k]), &(*column)[kept]);
    storeSelected(left, t1, &lines_.t1[kept]);
    kept += storeSelected(left, t2, &lines_.t2[kept]);
  }
  centreInside_ = beyond == 0, closed_ = open == 0;
  lines_.count = kept;
  for (auto* column : {&lines_.offset, &lines_.shift, &lines_.t1, &lines_.t2})
    storeLanes(&(*column)[kept], Lanes{});
}

/// Makes the normals unit vectors and lets each line end at the rim. Padded lines are empty.
void DiscClipper::scaleLines(double discRadius2) {
  const std::size_t padded = paddedToLanes(lines_.count);
  for (std::size_t k = lines_.count; k < padded; ++k) {
    lines_.ux[k] = lines_.uy[k] = lines_.shift[k] = 0;
    lines_.offset[k] = kFar, lines_.slope2[k] = 1;
  }
  for (std::size_t k = 0; k < padded; k += kLanes) {
    const Lanes inverse = 1 / squareRoot(loadLanes(&lines_.slope2[k]));
    for (auto* column : {&lines_.ux, &lines_.uy, &lines_.offset, &lines_.shift})
      storeLanes(&(*column)[k], loadLanes(&(*column)[k]) * inverse);
    const Lanes offset = loadLanes(&lines_.offset[k]), half2 = discRadius2 - offset * offset;
    const Lanes half = squareRoot(half2 > 0 ? half2 : Lanes{});
    storeLanes(&lines_.half[k], half), storeLanes(&lines_.t1[k], -half), storeLanes(&lines_.t2[k], half);
  }
}

namespace {

/// Sums over edges, a lane each, for one centre `height` from the disc's plane: how far the solid angle of
/// the triangle from the disc's centre to the edge falls short of the angle the edge spans there.
struct SolidSum {
  double height2, height;
  Lanes sum = {};

  explicit SolidSum(double signedHeight)
      : height2(signedHeight * signedHeight), height(std::abs(signedHeight)) {}

  /// Adds an edge; `side` = |D|.
  void add(const Lanes& sign, const Lanes& side, const Lanes& t1, const Lanes& t2) {
    const Lanes side2 = side * side, product = t1 * t2;
    const Lanes r1 = squareRoot(height2 + side2 + t1 * t1), r2 = squareRoot(height2 + side2 + t2 * t2);
    const Lanes turn = height * side * (t2 * r1 - t1 * r2);  // >= 0 but for round-off, as t/R grows with t
    sum += sign * upperAngle<Lanes>(turn > 0 ? turn : Lanes{}, side2 * r1 * r2 + height2 * product);
  }
};

}  // namespace

/// Angle the edges span at the disc's centre; without a rim they go all around it or not at all.
double DiscClipper::spannedAngle() const {
  const double whole = centreInside_ ? 2 * kPi : 0;
  if (closed_) return whole;
  Lanes angles = {};
  for (std::size_t k = 0; k < lines_.count; k += kLanes) {
    const Lanes t1 = loadLanes(&lines_.t1[k]), t2 = loadLanes(&lines_.t2[k]);
    const Lanes offset = loadLanes(&lines_.offset[k]), side = offset < 0 ? -offset : offset;
    const Lanes angle = upperAngle<Lanes>(side * (t2 - t1), side * side + t1 * t2);
    angles += offset < 0 ? -angle : angle;
  }
  const double angle = sumOf(angles);
  return whole - angle < kAngleRoundOff * static_cast<double>(lines_.count) ? whole : angle;
}

/// Sums area and solid angles over edges and rim. With the disc's centre c as corner, an edge at distance D
/// from t1 to t2 adds a triangle and takes its angle from the rim; the rim adds sectors of the disc and of
/// the cap.
void DiscClipper::integrate(double height, double heightShift, double discRadius2, const DiscBalls& balls,
                            FilmShape& out) const {
  const Lanes zero = {};
  Lanes triangles = {}, shifts = {};
  SolidSum near(height), far(balls.farHeight);
  for (std::size_t k = 0; k < lines_.count; k += kLanes) {
    const Lanes t1 = loadLanes(&lines_.t1[k]), t2 = loadLanes(&lines_.t2[k]);
    const Lanes offset = loadLanes(&lines_.offset[k]), length = t2 - t1;
    const Lanes sign = offset < 0 ? zero - 1 : zero + 1, side = sign * offset;
    triangles += offset * length;
    shifts += loadLanes(&lines_.shift[k]) * length;
    near.add(sign, side, t1, t2);
    far.add(sign, side, t1, t2);
  }
  const double angle = spannedAngle();
  out.arc = (centreInside_ ? 2 * kPi : 0) - angle;
  out.area = (sumOf(triangles) + discRadius2 * out.arc) / 2;
  out.areaShift = sumOf(shifts) + out.arc * (balls.radius * balls.radiusShift - height * heightShift);
  out.solidNear = angle - sumOf(near.sum) + (1 - near.height / balls.radius) * out.arc;
  out.solidFar = angle - sumOf(far.sum) + (1 - far.height / balls.farRadius) * out.arc;
}

}  // namespace spume::foam
