#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "fluid/dense_field.h"
#include "fluid/grid_spec.h"
#include "fluid/wall_sides.h"

namespace spume::fluid {

/// A solid of the scene. `psi` is its signed distance [m], > 0 outside the solid, at a world point and time;
/// `velocity` is the velocity of its material there [m/s].
struct SolidObject {
  std::string name;
  std::function<double(const Eigen::Vector3d& x, double t)> psi;
  std::function<Eigen::Vector3d(const Eigen::Vector3d& x, double t)> velocity;  ///< empty: at rest
  bool moves = false;
  /// psi at one time, for many points; empty: psi itself is asked.
  std::function<std::function<double(const Eigen::Vector3d& x)>(double t)> frozen = {};
};

/// Which of the six domain faces are walls (the others are open to the air). Order: -x +x -y +y -z +z.
struct DomainWalls {
  std::array<bool, 6> closed{true, true, true, false, true, true};
};

/// Open fractions below this count as closed: slivers would carry flux no cell can balance well, and their
/// weight in the pressure matrix only worsens its condition. A thousandth of a face is far below the error of
/// the cut [-].
inline constexpr float kMinOpenFraction = 1e-3f;

/// Solids as the solver sees them on the grid [Batty et al. 2007]. A face of which only the fraction f is
/// open carries the flux f u + (1 - f) uSolid. Boundary faces of closed domain walls have open = 0; those of
/// open ones open = 1 (less what a solid covers), with air at p = 0 outside.
struct SolidBoundary {
  DomainWalls walls;
  float cellEdge = 0;     ///< [m]
  DenseField<float> psi;  ///< distance to the nearest solid or closed wall at cell centres [m], ghosts
                          ///< included, > 0 in free space
  DenseField<std::int16_t>
      object;            ///< nearest solid per cell: index into the objects, -1 for a domain wall or none
  MacField<float> open;  ///< fraction of each face in free space, 0 or kMinOpenFraction..1
  MacField<float>
      velocity;  ///< normal velocity of the solid or inflow at each face that is not fully open [m/s]
  MacField<std::uint8_t> prescribed;  ///< 1 where an inflow sets the face velocity (open is 0 there)
  DenseField<float>
      cellFraction;  ///< free-space volume fraction of each cell, 0..1 (of the space, not the liquid)

  DenseField<std::uint8_t> shut;  ///< corners of a split cell that are not on the side it keeps, as bits
  WallSides sides;                ///< which cells are on the same side of thin walls

  std::vector<double>
      pose;  ///< distances and speeds of the moving solids at a few points: tells if they moved

  DenseField<float> nodePsi;  ///< distance to the nearest solid at cell corners [m]; domain walls left out
  DenseField<float> restNodePsi;  ///< the same of the solids at rest alone: what an update starts from
  DenseField<float> restPsi;      ///< psi of walls and solids at rest alone [m]
  DenseField<std::int16_t> restObject;

  /// True if some liquid could be in cell (i, j, k): one of its faces lets flow through.
  bool hasOpenFace(int i, int j, int k) const {
    return open[0](i, j, k) > 0 || open[0](i + 1, j, k) > 0 || open[1](i, j, k) > 0 ||
           open[1](i, j + 1, k) > 0 || open[2](i, j, k) > 0 || open[2](i, j, k + 1) > 0;
  }
};

/// Builds the boundary at time t. Corners are sampled and fractions are exact for the linear interpolant of
/// the corner values. A cell that a thin wall splits keeps one of its parts only, the larger: so nothing
/// flows through a wall at least one cell thick, at any position and angle.
SolidBoundary buildSolidBoundary(const GridSpec& grid, const DomainWalls& walls,
                                 const std::vector<SolidObject>& solids, double t);

/// Re-evaluates the moving solids at time t, in place; does nothing where none moves. Faces it rewrites lose
/// their `prescribed` mark: stamp the inflows afterwards.
/// Returns false if no solid has moved or turned since the last update, nor does now: then nothing is done.
bool updateSolidBoundary(const GridSpec& grid, const DomainWalls& walls,
                         const std::vector<SolidObject>& solids, double t, SolidBoundary& boundary);

/// Largest speed [m/s] of the surfaces of moving solids at time t, near where `boundary` has them.
double fastestSolid(const GridSpec& grid, const std::vector<SolidObject>& solids,
                    const SolidBoundary& boundary, double t);

}  // namespace spume::fluid
