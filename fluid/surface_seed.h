#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "fluid/dense_field.h"
#include "fluid/wall_sides.h"

namespace spume::fluid {

/// A closest point of the surface phi = 0: lengths in cells, positions in index units.
struct SurfaceSeed {
  float x, y, z;                 ///< on the surface
  float nx, ny, nz;              ///< unit normal, towards phi > 0
  float xx, yy, zz, xy, yz, zx;  ///< second derivatives of the distance [1/cells]
  float reach;                   ///< radius of the patch the normal and curvature speak for [cells]
};

/// The closest point to a cell beside the surface, on the cubic interpolant of phi or, where `kinks` marks
/// one, its limited quadratic; the crossing on the nearest grid line, without a normal, where none is found.
SurfaceSeed seedOf(const DenseField<float>& phi, const DenseField<std::uint8_t>& kinks,
                   const Eigen::Vector3i& cell);

/// The same beside a wall: the closest point of the plane that the values of the cell's own side make.
SurfaceSeed seedBesideWall(const DenseField<float>& phi, const WallSides& sides, const Eigen::Vector3i& cell);

}  // namespace spume::fluid
