#pragma once

#include <Eigen/Core>
#include <utility>

#include "coupling/scene.h"

namespace spume::coupling {

/// Signed distance from `x` to the shape's surface [m], < 0 inside. Exact (Euclidean) for every kind but
/// those from a file, which `distanceFromFile` reads; for them, and for `bounds` and `thickness`, infinite.
double signedDistance(const ShapeSpec& shape, const Eigen::Vector3d& x);

/// Low and high corner of the smallest box around the shape [m]; infinite along the axes a half-space is.
std::pair<Eigen::Vector3d, Eigen::Vector3d> bounds(const ShapeSpec& shape);

/// Signed distance from `x` to the room in a vessel [m], < 0 inside, reaching half way into its wall and
/// bottom and without end out of its mouth: what liquid in it may fill.
double roomInVessel(const ShapeSpec& vessel, const Eigen::Vector3d& x);

/// Smallest thickness of the shape, of a vessel's wall and bottom [m]; infinite for a half-space.
double thickness(const ShapeSpec& shape);

/// Whether the shape is read from a file: a mesh or a level set.
bool isFromFile(ShapeKind kind);

/// Throws KeyFault for what makes the shape unusable, such as an upper corner that is not above the lower.
void requireUsable(const ShapeSpec& shape);

/// A key of a shape and what a message says of its value: "radius", "= 0.1 m".
struct ShapeKey {
  std::string name, value;
};

/// The key that says where a shape is, "lower" or "centre".
ShapeKey placeKey(const ShapeSpec& shape);

/// The one that says how large it is: "upper", "radius", "inner_diameter"; its kind where none does.
ShapeKey sizeKey(const ShapeSpec& shape);

/// The scene's word for a kind: box, sphere, cylinder, half_space, vessel, mesh, level_set.
const char* nameOf(ShapeKind kind);

}  // namespace spume::coupling
