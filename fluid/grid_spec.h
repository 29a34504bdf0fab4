#pragma once

#include <Eigen/Core>

namespace spume::fluid {

/// The uniform grid all liquid fields share: `cells` cubes of edge `dx` [m] from the corner `origin` [m] up.
struct GridSpec {
  Eigen::Vector3i cells = Eigen::Vector3i::Zero();
  double dx = 0;                                       ///< cell edge [m]
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();    ///< low corner of cell (0, 0, 0) [m]

  /// Centre of cell (i, j, k) [m].
  Eigen::Vector3d cellCentre(int i, int j, int k) const {
    return origin + dx * Eigen::Vector3d(i + 0.5, j + 0.5, k + 0.5);
  }
  /// Centre of the minus face of cell (i, j, k) across `axis` [m].
  Eigen::Vector3d faceCentre(int axis, int i, int j, int k) const {
    Eigen::Vector3d centre = cellCentre(i, j, k);
    centre[axis] -= 0.5 * dx;
    return centre;
  }
  /// World position [m] in cell units from the low corner: cell (i, j, k) covers [i, i+1) x [j, j+1) x [k, k+1).
  Eigen::Vector3d toCells(const Eigen::Vector3d& world) const { return (world - origin) / dx; }
  Eigen::Vector3d toWorld(const Eigen::Vector3d& inCells) const { return origin + dx * inCells; }
  Eigen::Vector3d upper() const { return origin + dx * cells.cast<double>(); }
  double cellVolume() const { return dx * dx * dx; }
};

}  // namespace spume::fluid
