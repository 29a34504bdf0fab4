#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <vector>

#include "fluid/dense_field.h"
#include "fluid/grid_spec.h"

namespace spume::apps {

/// Triangles that do not share vertices: vertices 3t, 3t+1, 3t+2 make triangle t, counter-clockwise seen from
/// the side where the distance is positive. Equal corners are equal to the bit, so the surface has no cracks.
struct SurfaceMesh {
  std::vector<Eigen::Vector3f> position;  ///< [m]
  std::vector<Eigen::Vector3f> normal;    ///< gradient of the distance, unit length

  std::size_t triangles() const { return position.size() / 3; }
};

/// The zero level of `phi` inside the box [lower, upper] by marching tetrahedra on the cell centres. A last
/// layer of nodes lies on the walls of the box, so the surface ends exactly there.
SurfaceMesh meshLevelSet(const fluid::GridSpec& grid, const fluid::DenseField<float>& phi,
                         const Eigen::Vector3d& lower, const Eigen::Vector3d& upper);

/// The zero level of a distance function inside the box, found with about `cells` cells along the box's
/// longest edge; corners and normals then taken from the function itself, so that round things come out
/// smooth.
SurfaceMesh meshDistance(const std::function<double(const Eigen::Vector3d&)>& distance,
                         const Eigen::Vector3d& lower, const Eigen::Vector3d& upper, int cells);

}  // namespace spume::apps
