#pragma once

#include <Eigen/Core>
#include <utility>

#include "coupling/scene.h"

namespace spume::coupling {

/// Signed distance from `x` to the shape's surface [m], < 0 inside. Exact (Euclidean) for every kind.
double signedDistance(const ShapeSpec& shape, const Eigen::Vector3d& x);

/// Low and high corner of the smallest box around the shape [m]; infinite along the axes a half-space is.
std::pair<Eigen::Vector3d, Eigen::Vector3d> bounds(const ShapeSpec& shape);

/// Smallest thickness of the shape [m]; infinite for a half-space.
double thickness(const ShapeSpec& shape);

/// What makes the shape unusable ("upper must exceed lower on every axis"), or an empty string.
std::string defect(const ShapeSpec& shape);

/// The scene's word for a kind: box, sphere, cylinder, half_space.
const char* nameOf(ShapeKind kind);

}  // namespace spume::coupling
