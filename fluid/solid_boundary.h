#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "fluid/dense_field.h"
#include "fluid/grid_spec.h"

namespace spume::fluid {

/// A solid of the scene. `psi` is its signed distance [m], > 0 outside the solid, at a world point and time;
/// `velocity` is the velocity of its material there [m/s].
struct SolidObject {
  std::string name;
  std::function<double(const Eigen::Vector3d& x, double t)> psi;
  std::function<Eigen::Vector3d(const Eigen::Vector3d& x, double t)> velocity;   ///< empty: at rest
  bool moves = false;
};

/// A region that pours liquid in: inside it phi < 0 and the liquid moves with `velocity`.
struct Inflow {
  std::string name;
  std::function<double(const Eigen::Vector3d& x)> sdf;   ///< < 0 inside the region [m]
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();     ///< [m/s]
  double area = 0;                                        ///< true area of the outlet [m^2]; flux is exactly |velocity| area
  std::function<double(double t)> scale;                  ///< multiplies the velocity; 0 = closed. Empty: always 1
  double turbulence = 0;                                  ///< rms relative fluctuation of the axial speed, 0 to 0.5
};

/// Which of the six domain faces are walls (the others are open to the air). Order: -x +x -y +y -z +z.
struct DomainWalls {
  std::array<bool, 6> closed{true, true, true, false, true, true};
};

/// Solids as the solver sees them on the grid [Batty et al. 2007]. A face of which only the fraction f is open
/// carries the flux f u + (1 - f) uSolid.
struct SolidBoundary {
  DenseField<float> psi;             ///< distance to the nearest solid or closed wall at cell centres [m], > 0 in free space
  DenseField<std::int16_t> object;   ///< nearest solid per cell: index into the objects, -1 for a domain wall
  MacField<float> open;              ///< fraction of each face in free space, 0..1
  MacField<float> velocity;          ///< normal velocity of the solid or inflow at each face [m/s]
  MacField<std::uint8_t> prescribed; ///< 1 where an inflow sets the face velocity

  /// Fluid volume fraction of each cell, 0..1, of the free space (not of the liquid).
  DenseField<float> cellFraction;
};

/// Builds the boundary at time t. Nodes are sampled so that a wall is found at any sub-cell position.
SolidBoundary buildSolidBoundary(const GridSpec& grid, const DomainWalls& walls,
                                 const std::vector<SolidObject>& solids, double t);

/// Re-evaluates only what moves, in place.
void updateSolidBoundary(const GridSpec& grid, const DomainWalls& walls, const std::vector<SolidObject>& solids,
                         double t, SolidBoundary& boundary);

}  // namespace spume::fluid
