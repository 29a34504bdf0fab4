#include "foam/film_polygon.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace spume::foam {

namespace {

using Real = FilmPolygon::Real;

/// Signed solid angle of the triangle with corners a, b and the foot of the perpendicular from an apex
/// `height` above the plane (van Oosterom and Strackee, with the foot's direction for the foot, so that
/// height 0 is no special case).
Real solidAngle(Real cross, Real dot, Real a2, Real b2, Real height) {
  const Real h2 = height * height, ra = std::sqrt(a2 + h2), rb = std::sqrt(b2 + h2);
  return 2 * std::atan2(cross, ra * rb + height * (ra + rb) + dot + h2);
}

}  // namespace

FilmPolygon::FilmPolygon(const TieBrokenBall& near, const TieBrokenBall& far, const Point& apart)
    : near_(near), far_(far) {
  const Real d = apart.norm(), r = near.radius, s = far.radius;
  normal_ = apart / d;
  u_ = normal_.unitOrthogonal();
  v_ = normal_.cross(u_);
  height_ = (d + (r - s) * (r + s) / d) / 2;
  farHeight_ = d - height_;
  discRadius2_ = (r - height_) * (r + height_);
  heightShift_ = radicalHeightShift(near, far, static_cast<double>(d));
}

void FilmPolygon::addCorner(const Point& corner, const Point& edgeSite, double edgeHeightShift) {
  const Point other = edgeSite.normalized();
  const Real slope = other.cross(normal_).norm();
  const Real shift = slope > 0 ? (edgeHeightShift - heightShift_ * other.dot(normal_)) / slope : 0;
  edges_.push_back({{corner.dot(u_), corner.dot(v_)}, shift});
}

FilmShape FilmPolygon::integrate() const {
  Sums sums;
  Real turning = 0;
  for (std::size_t k = 0; k < edges_.size(); ++k) {
    const Edge &from = edges_[k], &to = edges_[(k + 1) % edges_.size()];
    addEdge(from.corner, to.corner, from.shiftOfLine, sums);
    turning += from.corner.x() * to.corner.y() - from.corner.y() * to.corner.x();
  }
  const Real sign = turning < 0 ? -1 : 1;
  const Real arc = std::max<Real>(0, sign * sums.rim);
  const auto capShare = [](Real height, Real radius) { return 1 - std::abs(height) / radius; };
  FilmShape shape;
  shape.heightShift = static_cast<float>(heightShift_);
  shape.arc = static_cast<double>(arc);
  shape.area = static_cast<double>((sign * sums.triangles + discRadius2_ * arc) / 2);
  shape.areaShift =
      static_cast<float>(sums.shifts + arc * (near_.radius * near_.radiusShift - height_ * heightShift_));
  shape.solidNear = static_cast<double>(sign * sums.solidNear + capShare(height_, near_.radius) * arc);
  shape.solidFar = static_cast<double>(sign * sums.solidFar + capShare(farHeight_, far_.radius) * arc);
  return shape;
}

/// Splits the edge where it enters and leaves the disc; outside, the rim stands in for it.
void FilmPolygon::addEdge(const Point2& a, const Point2& b, Real shift, Sums& sums) const {
  const Real length = (b - a).norm();
  if (!(length > 0)) return;
  const Point2 along = (b - a) / length;
  const Point2 foot = a - a.dot(along) * along;
  const Real start = a.dot(along), end = b.dot(along), half2 = discRadius2_ - foot.squaredNorm();
  const Real half = half2 > 0 ? std::sqrt(half2) : 0;
  const Real enter = std::max(start, -half), leave = std::min(end, half);
  if (!(half > 0) || leave <= enter) return addOutside(a, b, sums);
  const Point2 in = enter > start ? Point2(foot + enter * along) : a;
  const Point2 out = leave < end ? Point2(foot + leave * along) : b;
  if (enter > start) addOutside(a, in, sums);
  addInside(in, out, shift, sums);
  if (leave < end) addOutside(out, b, sums);
}

void FilmPolygon::addInside(const Point2& a, const Point2& b, Real shift, Sums& sums) const {
  const Real cross = a.x() * b.y() - a.y() * b.x(), dot = a.dot(b), a2 = a.squaredNorm(),
             b2 = b.squaredNorm();
  sums.triangles += cross;
  sums.shifts += shift * (b - a).norm();
  sums.solidNear += solidAngle(cross, dot, a2, b2, std::abs(height_));
  sums.solidFar += solidAngle(cross, dot, a2, b2, std::abs(farHeight_));
}

void FilmPolygon::addOutside(const Point2& a, const Point2& b, Sums& sums) const {
  sums.rim += std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
}

}  // namespace spume::foam
