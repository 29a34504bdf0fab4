#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "fluid/dense_field.h"
#include "fluid/grid_spec.h"
#include "fluid/solid_boundary.h"

namespace spume::fluid {

/// Liquid slips along walls: du/dn = 0. Faces that a wall cuts so that their middle lies inside it take the
/// velocity that the liquid in front of the wall has, a cell away from it. Carried by their own velocity
/// they would be streams of their own along the wall, which nothing slows down: beside a mug's round wall
/// columns of slivers went at a metre a second past water at rest, and stirred it for ever.
class WallSlip {
 public:
  explicit WallSlip(const GridSpec& grid) : grid_(grid) {}

  /// Finds those faces and where each looks. Call again whenever solids have moved.
  void rebuild(const SolidBoundary& solids);
  /// Overwrites their velocities. Ghosts must be filled and stand for what they were: constrainToSolids
  /// follows.
  void apply(MacVelocity& velocity);

 private:
  struct CutFace {
    std::int32_t offset;     ///< in its component
    Eigen::Vector3f inside;  ///< where it looks [cells]
  };
  GridSpec grid_;
  std::array<std::vector<CutFace>, 3> faces_;
  std::array<std::vector<float>, 3> values_;
};

}  // namespace spume::fluid
