#include "coupling/shapes.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace spume::coupling {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Distance of a point from a corner-free box given its excess over the half size on each axis, < 0 inside.
template <typename Vector>
double distanceFromExcess(const Vector& excess) {
  return excess.cwiseMax(0.0).norm() + std::min(excess.maxCoeff(), 0.0);
}

double boxDistance(const ShapeSpec& box, const Eigen::Vector3d& x) {
  const Eigen::Vector3d centre = 0.5 * (box.lower + box.upper);
  const Eigen::Vector3d half = 0.5 * (box.upper - box.lower);
  return distanceFromExcess(Eigen::Vector3d((x - centre).cwiseAbs() - half));
}

double cylinderDistance(const ShapeSpec& cylinder, const Eigen::Vector3d& x) {
  const Eigen::Vector3d axis = cylinder.axis.normalized();
  const Eigen::Vector3d offset = x - cylinder.centre;
  const double along = offset.dot(axis);
  const double across = (offset - along * axis).norm();
  return distanceFromExcess(
      Eigen::Vector2d(across - cylinder.radius, std::abs(along) - 0.5 * cylinder.height));
}

bool needsRadius(ShapeKind kind) { return kind == ShapeKind::sphere || kind == ShapeKind::cylinder; }
bool needsAxis(ShapeKind kind) { return kind == ShapeKind::cylinder || kind == ShapeKind::halfSpace; }

/// Half extent of a cylinder along each world axis: its length and its disc seen from that axis.
Eigen::Vector3d cylinderHalfExtent(const ShapeSpec& cylinder) {
  const Eigen::Array3d axis = cylinder.axis.normalized().array();
  return 0.5 * cylinder.height * axis.abs() + cylinder.radius * (1 - axis.square()).max(0.0).sqrt();
}

}  // namespace

double signedDistance(const ShapeSpec& shape, const Eigen::Vector3d& x) {
  switch (shape.kind) {
    case ShapeKind::box:
      return boxDistance(shape, x);
    case ShapeKind::sphere:
      return (x - shape.centre).norm() - shape.radius;
    case ShapeKind::cylinder:
      return cylinderDistance(shape, x);
    case ShapeKind::halfSpace:
      return (x - shape.centre).dot(shape.axis.normalized());
  }
  return kInfinity;
}

std::pair<Eigen::Vector3d, Eigen::Vector3d> bounds(const ShapeSpec& shape) {
  if (shape.kind == ShapeKind::box) return {shape.lower, shape.upper};
  if (shape.kind == ShapeKind::halfSpace)
    return {Eigen::Vector3d::Constant(-kInfinity), Eigen::Vector3d::Constant(kInfinity)};
  const Eigen::Vector3d half =
      shape.kind == ShapeKind::sphere ? Eigen::Vector3d::Constant(shape.radius) : cylinderHalfExtent(shape);
  return {shape.centre - half, shape.centre + half};
}

double thickness(const ShapeSpec& shape) {
  switch (shape.kind) {
    case ShapeKind::box:
      return (shape.upper - shape.lower).minCoeff();
    case ShapeKind::sphere:
      return 2 * shape.radius;
    case ShapeKind::cylinder:
      return std::min(2 * shape.radius, shape.height);
    case ShapeKind::halfSpace:
      break;
  }
  return kInfinity;
}

std::string defect(const ShapeSpec& shape) {
  if (shape.kind == ShapeKind::box && !((shape.upper - shape.lower).minCoeff() > 0))
    return "upper must exceed lower on every axis";
  if (needsRadius(shape.kind) && !(shape.radius > 0)) return "radius must be greater than 0 [m]";
  if (shape.kind == ShapeKind::cylinder && !(shape.height > 0)) return "height must be greater than 0 [m]";
  if (needsAxis(shape.kind) && !(shape.axis.norm() > 0)) return "axis must not be the zero vector";
  return {};
}

const char* nameOf(ShapeKind kind) {
  constexpr const char* kNames[] = {"box", "sphere", "cylinder", "half_space"};
  return kNames[static_cast<int>(kind)];
}

}  // namespace spume::coupling
