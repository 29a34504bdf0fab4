#pragma once

#include <Eigen/Core>
#include <string>

#include "coupling/scene.h"

namespace spume::coupling {

/// The box of a scene's domain [m], its edges rounded to whole cells as the grid has them: what is inside for
/// walls, checks, sources and bubbles that leave.
struct DomainBox {
  Eigen::Vector3d lower, upper;

  explicit DomainBox(const Scene& scene);

  Eigen::Vector3d size() const { return upper - lower; }
  double volume() const { return size().prod(); }
  /// Whether x [m] lies in it, faces included.
  bool holds(const Eigen::Vector3d& x) const;
  /// Whether a ball of `radius` [m] round x [m] reaches into it, taken as a box along its corners.
  bool reaches(const Eigen::Vector3d& x, double radius) const;
  /// Throws KeyFault where the shape and the domain have no volume in common.
  void requireOverlap(const ShapeSpec& shape) const;
  /// "the domain from [0, 0, 0] to [1, 1, 1] m", for messages.
  std::string words() const;
};

}  // namespace spume::coupling
