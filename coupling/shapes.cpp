#include "coupling/shapes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "coupling/object_label.h"
#include "coupling/toml_slot.h"

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

/// Where a point lies in the half plane through an axis.
struct AxialPoint {
  double across, along;  // [m]
};
AxialPoint axialPoint(const ShapeSpec& shape, const Eigen::Vector3d& x) {
  const Eigen::Vector3d axis = shape.axis.normalized(), offset = x - shape.centre;
  const double along = offset.dot(axis);
  return {(offset - along * axis).norm(), along};
}

/// Distance from a rectangle of the half plane, < 0 inside.
double rectangleDistance(const AxialPoint& p, const Eigen::Vector2d& lower, const Eigen::Vector2d& upper) {
  const Eigen::Vector2d at(p.across, p.along);
  return distanceFromExcess(Eigen::Vector2d((at - 0.5 * (lower + upper)).cwiseAbs() - 0.5 * (upper - lower)));
}

double cylinderDistance(const ShapeSpec& cylinder, const Eigen::Vector3d& x) {
  const AxialPoint p = axialPoint(cylinder, x);
  return distanceFromExcess(
      Eigen::Vector2d(p.across - cylinder.radius, std::abs(p.along) - 0.5 * cylinder.height));
}

/// A vessel's section is an L of wall and bottom. Outside, the nearer of the two; inside, the nearer of the
/// outer rectangle's edge and the room.
double vesselDistance(const ShapeSpec& vessel, const Eigen::Vector3d& x) {
  const AxialPoint p = axialPoint(vessel, x);
  const double inner = 0.5 * vessel.innerDiameter, outer = inner + vessel.wallThickness;
  const double bottom = -vessel.bottomThickness, rim = vessel.innerHeight;
  const double wall = rectangleDistance(p, {inner, bottom}, {outer, rim});
  const double floor = rectangleDistance(p, {-outer, bottom}, {outer, 0});
  if (wall > 0 && floor > 0) return std::min(wall, floor);
  const double room = distanceFromExcess(Eigen::Vector2d(p.across - inner, -p.along));
  return std::max(rectangleDistance(p, {-outer, bottom}, {outer, rim}), -room);
}

Eigen::Vector3d vesselMiddle(const ShapeSpec& vessel) {
  return vessel.centre + 0.5 * (vessel.innerHeight - vessel.bottomThickness) * vessel.axis.normalized();
}

bool needsRadius(ShapeKind kind) { return kind == ShapeKind::sphere || kind == ShapeKind::cylinder; }
bool needsAxis(ShapeKind kind) {
  return kind == ShapeKind::cylinder || kind == ShapeKind::halfSpace || kind == ShapeKind::vessel;
}

/// Half extent of a cylinder along each world axis: its length and its disc seen from that axis.
Eigen::Vector3d cylinderHalfExtent(const Eigen::Vector3d& along, double height, double radius) {
  const Eigen::Array3d axis = along.normalized().array();
  return 0.5 * height * axis.abs() + radius * (1 - axis.square()).max(0.0).sqrt();
}

Eigen::Vector3d halfExtent(const ShapeSpec& shape) {
  switch (shape.kind) {
    case ShapeKind::sphere:
      return Eigen::Vector3d::Constant(shape.radius);
    case ShapeKind::cylinder:
      return cylinderHalfExtent(shape.axis, shape.height, shape.radius);
    case ShapeKind::vessel:
      return cylinderHalfExtent(shape.axis, shape.innerHeight + shape.bottomThickness,
                                0.5 * shape.innerDiameter + shape.wallThickness);
    default:
      return Eigen::Vector3d::Constant(kInfinity);
  }
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
    case ShapeKind::vessel:
      return vesselDistance(shape, x);
    case ShapeKind::mesh:
    case ShapeKind::levelSet:
      break;
  }
  return kInfinity;
}

double roomInVessel(const ShapeSpec& vessel, const Eigen::Vector3d& x) {
  const AxialPoint p = axialPoint(vessel, x);
  return distanceFromExcess(Eigen::Vector2d(p.across - 0.5 * (vessel.innerDiameter + vessel.wallThickness),
                                            -p.along - 0.5 * vessel.bottomThickness));
}

std::pair<Eigen::Vector3d, Eigen::Vector3d> bounds(const ShapeSpec& shape) {
  if (shape.kind == ShapeKind::box) return {shape.lower, shape.upper};
  const Eigen::Vector3d half = halfExtent(shape);
  const Eigen::Vector3d middle = shape.kind == ShapeKind::vessel ? vesselMiddle(shape) : shape.centre;
  return {middle - half, middle + half};
}

double thickness(const ShapeSpec& shape) {
  switch (shape.kind) {
    case ShapeKind::box:
      return (shape.upper - shape.lower).minCoeff();
    case ShapeKind::sphere:
      return 2 * shape.radius;
    case ShapeKind::cylinder:
      return std::min(2 * shape.radius, shape.height);
    case ShapeKind::vessel:
      return std::min(shape.wallThickness, shape.bottomThickness);
    default:
      return kInfinity;
  }
}

bool isFromFile(ShapeKind kind) { return kind == ShapeKind::mesh || kind == ShapeKind::levelSet; }

void requireUsable(const ShapeSpec& shape) {
  const std::string kind = nameOf(shape.kind);
  const auto requirePositive = [&](const char* key, double value) {
    if (!(value > 0)) throw KeyFault(key, "= " + exactText(value) + " m; a " + kind + " needs more than 0 m");
  };
  if (shape.kind == ShapeKind::box && !((shape.upper - shape.lower).minCoeff() > 0))
    throw KeyFault("upper", "= " + exactText(shape.upper) +
                                " m must exceed lower = " + exactText(shape.lower) + " m on every axis");
  if (needsRadius(shape.kind)) requirePositive("radius", shape.radius);
  if (shape.kind == ShapeKind::cylinder) requirePositive("height", shape.height);
  if (shape.kind == ShapeKind::vessel) {
    requirePositive("inner_diameter", shape.innerDiameter);
    requirePositive("inner_height", shape.innerHeight);
    requirePositive("wall_thickness", shape.wallThickness);
    requirePositive("bottom_thickness", shape.bottomThickness);
  }
  if (isFromFile(shape.kind) && shape.file.empty())
    throw KeyFault("file", shape.kind == ShapeKind::mesh ? "is missing; name the mesh, .obj or .ply"
                                                         : "is missing; name the level set, .vdb");
  if (needsAxis(shape.kind) && !(shape.axis.norm() > 0))
    throw KeyFault("axis", "= [0, 0, 0] has no direction; [0, 1, 0] points upwards");
}

ShapeKey placeKey(const ShapeSpec& shape) {
  if (shape.kind == ShapeKind::box) return {"lower", "= " + exactText(shape.lower) + " m"};
  return {"centre", "= " + exactText(shape.centre) + " m"};
}

ShapeKey sizeKey(const ShapeSpec& shape) {
  switch (shape.kind) {
    case ShapeKind::box:
      return {"upper", "= " + exactText(shape.upper) + " m"};
    case ShapeKind::sphere:
    case ShapeKind::cylinder:
      return {"radius", "= " + exactText(shape.radius) + " m"};
    case ShapeKind::vessel:
      return {"inner_diameter", "= " + exactText(shape.innerDiameter) + " m"};
    default:
      return {"shape", "= " + quoted(nameOf(shape.kind))};
  }
}

const char* nameOf(ShapeKind kind) {
  constexpr const char* kNames[] = {"box", "sphere", "cylinder", "half_space", "vessel", "mesh", "level_set"};
  return kNames[static_cast<int>(kind)];
}

}  // namespace spume::coupling
