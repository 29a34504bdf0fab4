#include "foam/disc_clipper.h"

#include <limits>

namespace spume::foam {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kFar =
    std::numeric_limits<double>::max() / 4;  ///< stands for infinity where products are formed

constexpr double kAngleRoundOff = 1e-15;  ///< of one edge's angle, a few ulp of pi

/// Calls body(k) for all k below `count` rounded up to whole blocks.
template <typename Body>
inline void forEachLane(std::size_t count, const Body& body) {
  for (std::size_t block = 0; block < count; block += kLanes)
    for (std::size_t lane = 0; lane < kLanes; ++lane) body(block + lane);
}

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

}  // namespace

void CuttingPlanes::resize(std::size_t planes) {
  count = planes;
  const std::size_t padded = paddedToLanes(planes);
  for (auto* column : {&nx, &ny, &nz, &heightShift}) {
    column->resize(std::max(column->size(), padded));
    std::fill(column->begin() + static_cast<std::ptrdiff_t>(planes),
              column->begin() + static_cast<std::ptrdiff_t>(padded), 0.0);
  }
  height.resize(std::max(height.size(), padded));
  std::fill(height.begin() + static_cast<std::ptrdiff_t>(planes),
            height.begin() + static_cast<std::ptrdiff_t>(padded), 1.0);
}

void DiscClipper::Lines::resize(std::size_t lines) {
  const std::size_t padded = paddedToLanes(lines);
  if (ux.size() >= padded) return;
  for (auto* column : {&ux, &uy, &offset, &shift, &t1, &t2}) column->resize(padded);
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

/// Collects the lines that cut the disc; false if a plane cuts all of it away.
bool DiscClipper::findLines(const CuttingPlanes& planes, std::size_t face, double discRadius2) {
  const std::size_t padded = paddedToLanes(planes.count);
  if (px_.size() < padded)
    for (auto* column : {&px_, &py_, &toPlane_, &alongNormal_}) column->resize(padded);
  lines_.resize(planes.count);
  const double nx = planes.nx[face], ny = planes.ny[face], nz = planes.nz[face], height = planes.height[face];
  const PlaneFrame frame(nx, ny, nz);
  frame_ = {
      height * Eigen::Vector3d(nx, ny, nz), {frame.ux, frame.uy, frame.uz}, {frame.vx, frame.vy, frame.vz}};
  const double *kx = planes.nx.data(), *ky = planes.ny.data(), *kz = planes.nz.data();
  const double *kh = planes.height.data(), *kShift = planes.heightShift.data();
  double* __restrict px = px_.data(), * __restrict py = py_.data();
  double* __restrict toPlane = toPlane_.data(), * __restrict along = alongNormal_.data();
  forEachLane(planes.count, [&](std::size_t k) {
    px[k] = kx[k] * frame.ux + ky[k] * frame.uy + kz[k] * frame.uz;
    py[k] = kx[k] * frame.vx + ky[k] * frame.vy + kz[k] * frame.vz;
    along[k] = kx[k] * nx + ky[k] * ny + kz[k] * nz;
    toPlane[k] = kh[k] - height * along[k];
  });
  std::size_t m = 0;
  bool gone = false;
  for (std::size_t k = 0; k < planes.count; ++k) {
    if (k == face) continue;
    const double slope2 = px[k] * px[k] + py[k] * py[k];
    const bool cuts = toPlane[k] * toPlane[k] < discRadius2 * slope2;
    gone |= !cuts && toPlane[k] < 0;
    lines_.ux[m] = px[k], lines_.uy[m] = py[k], lines_.offset[m] = toPlane[k];
    lines_.shift[m] = kShift[k] - along[k] * planes.heightShift[face];
    m += cuts;
  }
  lines_.count = m;
  for (std::size_t k = m; k < paddedToLanes(m); ++k)
    lines_.ux[k] = lines_.uy[k] = lines_.offset[k] = lines_.shift[k] = 0;
  return !gone;
}

/// Cuts each line by the disc and all other lines; false if lines cut the disc and nothing is left.
bool DiscClipper::clipLines(double discRadius2) {
  const std::size_t m = lines_.count;
  if (m == 0) return true;
  double* __restrict ux = lines_.ux.data(), * __restrict uy = lines_.uy.data();
  double* __restrict offset = lines_.offset.data(), * __restrict shift = lines_.shift.data();
  double* __restrict t1 = lines_.t1.data(), * __restrict t2 = lines_.t2.data();
  forEachLane(m, [&](std::size_t k) {
    const double slope2 = ux[k] * ux[k] + uy[k] * uy[k];
    const double inverse = 1 / std::sqrt(slope2 > 0 ? slope2 : 1);
    ux[k] *= inverse, uy[k] *= inverse, offset[k] *= inverse, shift[k] *= inverse;
    const double half2 = discRadius2 - offset[k] * offset[k];
    const double half = slope2 > 0 && half2 > 0 ? std::sqrt(half2) : 0;
    t1[k] = -half, t2[k] = half;
  });
  for (std::size_t l = 0; l < m; ++l) {
    const double lx = ux[l], ly = uy[l], ld = offset[l], t1Own = t1[l], t2Own = t2[l];
    forEachLane(m, [&](std::size_t k) {
      const double slope = ly * ux[k] - lx * uy[k];
      const double gap = ld - offset[k] * (lx * ux[k] + ly * uy[k]);
      const double t = gap / slope;
      const double upper = slope > 0 ? t : slope == 0 && gap < 0 ? -kFar : kFar;
      const double lower = slope < 0 ? t : -kFar;
      t2[k] = t2[k] < upper ? t2[k] : upper;
      t1[k] = t1[k] > lower ? t1[k] : lower;
    });
    t1[l] = t1Own, t2[l] = t2Own;
  }
  bool anyLeft = false;
  for (std::size_t k = 0; k < m; ++k) anyLeft |= t2[k] > t1[k];
  return anyLeft;
}

/// Sums area and solid angles over edges and rim. With the disc's centre c as corner, an edge at distance D
/// from t1 to t2 adds a triangle and takes its angle from the rim; the rim adds sectors of the disc and of
/// the cap.
void DiscClipper::integrate(double height, double heightShift, double discRadius2, const DiscBalls& balls,
                            FilmShape& out) const {
  const std::size_t m = lines_.count;
  const double near = std::abs(height), far = std::abs(balls.farHeight);
  const double near2 = near * near, far2 = far * far;
  const double *offset = lines_.offset.data(), *shift = lines_.shift.data();
  const double *t1 = lines_.t1.data(), *t2 = lines_.t2.data();
  double triangles[kLanes] = {}, angles[kLanes] = {}, shifts[kLanes] = {}, nearSolid[kLanes] = {};
  double farSolid[kLanes] = {};
  for (std::size_t block = 0; block < m; block += kLanes)
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const std::size_t k = block + lane;
      const bool left = t2[k] > t1[k];
      const double a = left ? t1[k] : 0, b = left ? t2[k] : 0, d = offset[k];
      const double sign = d < 0 ? -1 : 1, side = std::abs(d), length = b - a, d2 = d * d, ab = a * b;
      const double nearA = std::sqrt(near2 + d2 + a * a), nearB = std::sqrt(near2 + d2 + b * b);
      const double farA = std::sqrt(far2 + d2 + a * a), farB = std::sqrt(far2 + d2 + b * b);
      const double angle = sign * upperAngle(side * length, d2 + ab);
      triangles[lane] += d * length;
      shifts[lane] += shift[k] * length;
      angles[lane] += angle;
      // t2 R1 - t1 R2 >= 0, as t/R grows with t.
      nearSolid[lane] += angle - sign * upperAngle(std::max(0.0, near * side * (b * nearA - a * nearB)),
                                                   d2 * nearA * nearB + near2 * ab);
      farSolid[lane] += angle - sign * upperAngle(std::max(0.0, far * side * (b * farA - a * farB)),
                                                  d2 * farA * farB + far2 * ab);
    }
  bool centreInside = true;
  for (std::size_t k = 0; k < m; ++k) centreInside &= offset[k] >= 0;
  double triangle = 0, angle = 0, edgeShift = 0, solidNear = 0, solidFar = 0;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    triangle += triangles[lane], angle += angles[lane], edgeShift += shifts[lane];
    solidNear += nearSolid[lane], solidFar += farSolid[lane];
  }
  out.arc = (centreInside ? 2 * kPi : 0) - angle;
  if (out.arc < kAngleRoundOff * static_cast<double>(m)) out.arc = 0;
  out.area = (triangle + discRadius2 * out.arc) / 2;
  out.areaShift = edgeShift + out.arc * (balls.radius * balls.radiusShift - height * heightShift);
  out.solidNear = solidNear + (1 - near / balls.radius) * out.arc;
  out.solidFar = solidFar + (1 - far / balls.farRadius) * out.arc;
}

Eigen::Vector3d DiscClipper::pointInside() const {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  int edges = 0;
  for (std::size_t k = 0; k < lines_.count; ++k) {
    if (!(lines_.t2[k] > lines_.t1[k])) continue;
    const Eigen::Vector2d normal(lines_.ux[k], lines_.uy[k]), along(-lines_.uy[k], lines_.ux[k]);
    sum += lines_.offset[k] * normal + (lines_.t1[k] + lines_.t2[k]) / 2 * along;
    ++edges;
  }
  const Eigen::Vector2d mean = sum / std::max(edges, 1);
  return frame_.origin + mean.x() * frame_.u + mean.y() * frame_.v;
}

double DiscClipper::farthestCorner2() const {
  double farthest2 = 0;
  for (std::size_t k = 0; k < lines_.count; ++k) {
    if (!(lines_.t2[k] > lines_.t1[k])) continue;
    const double end = std::max(std::abs(lines_.t1[k]), std::abs(lines_.t2[k]));
    farthest2 = std::max(farthest2, lines_.offset[k] * lines_.offset[k] + end * end);
  }
  return frame_.origin.squaredNorm() + farthest2;
}

}  // namespace spume::foam
