#pragma once

#include "coupling/scene.h"

namespace spume::coupling::test {

inline ShapeSpec boxShape(const Eigen::Vector3d& lower, const Eigen::Vector3d& upper) {
  ShapeSpec shape;
  shape.kind = ShapeKind::box;
  shape.lower = lower, shape.upper = upper;
  return shape;
}

inline ShapeSpec ballShape(const Eigen::Vector3d& centre, double radius) {
  ShapeSpec shape;
  shape.kind = ShapeKind::sphere;
  shape.centre = centre, shape.radius = radius;
  return shape;
}

/// Upright.
inline ShapeSpec cylinderShape(const Eigen::Vector3d& centre, double radius, double height) {
  ShapeSpec shape;
  shape.kind = ShapeKind::cylinder;
  shape.centre = centre, shape.radius = radius, shape.height = height;
  return shape;
}

inline SolidSpec solidOf(const std::string& name, const ShapeSpec& shape) {
  SolidSpec solid;
  solid.name = name;
  solid.shape = shape;
  return solid;
}

inline LiquidBodySpec bodyOf(const std::string& name, const ShapeSpec& shape) {
  LiquidBodySpec body;
  body.name = name;
  body.shape = shape;
  return body;
}

}  // namespace spume::coupling::test
