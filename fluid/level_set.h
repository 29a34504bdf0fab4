#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "fluid/dense_field.h"
#include "fluid/grid_spec.h"
#include "fluid/solid_boundary.h"

namespace spume::fluid {

/// Half-width of the band in which phi is a signed distance [cells]; beyond it phi = +-kLevelSetBand dx. Must
/// hold the marker band (3), one sub-step of motion and the stencils (model, "Liquid"; 3 is too thin).
inline constexpr int kLevelSetBand = 6;

/// Sets the ghost layers of a cell-centred field by reflection in the domain faces: zero normal slope, so a
/// wall meets the surface at 90 degrees.
void fillGhostLayers(DenseField<float>& field);

/// Sets the ghost layers of a staggered velocity to the nearest value inside.
void fillGhostLayers(MacVelocity& velocity);

/// Signed distance of a function of world position [m], clamped to the band, ghosts filled.
void initialiseLevelSet(const GridSpec& grid, const std::function<double(const Eigen::Vector3d&)>& phi0,
                        DenseField<float>& phi);

/// Continues cell-centred fields into the solids along the wall normal, by reflection: nothing may read past
/// a wall, and the surface meets it at 90 degrees (model, "Liquid").
class SolidExtension {
 public:
  /// Finds the cells behind walls and their mirror points. Call again whenever solids have moved.
  void rebuild(const GridSpec& grid, const SolidBoundary& solids);
  /// Overwrites `field` behind the walls (the reflection reaches at most kMirrorReach cells into the
  /// free space, deeper cells repeat that value) and in the ghosts.
  void apply(DenseField<float>& field) const;

 private:
  struct Mirror {
    std::int32_t cell;  ///< offset of the cell in the field
    std::int32_t base;  ///< offset of the low corner of the mirror point's interpolation cube
    float weight[8];    ///< trilinear weights of the cube's corners, z fastest
    float wet[8];       ///< the same over corners in free space only, summing to 1 (or all 0)
  };
  Mirror mirrorOf(const GridSpec& grid, const SolidBoundary& solids, int i, int j, int k) const;
  void fill(DenseField<float>& field, bool wetOnly) const;

  std::vector<Mirror> mirrors_;
  mutable std::vector<float> value_;  ///< scratch of `apply`, one per mirror
};

/// Fraction 0..1 of the free space of cell (i, j, k) that is liquid: trilinear phi in its eight octants, each
/// cut by its own plane, with the curvature of the interpolant taken out. `phi` must have its ghosts filled.
float liquidFractionOfCell(const DenseField<float>& phi, float dx, int i, int j, int k);

/// The same for every cell, times the fluid fraction of the cell: liquid volume in units of dx^3.
void computeLiquidFraction(const DenseField<float>& phi, const SolidBoundary& solids, float dx,
                           DenseField<float>& fraction);

/// Volume of the grid liquid [m^3]: sum of the above times dx^3, in double, the same on any number of
/// threads.
double liquidVolume(const GridSpec& grid, const DenseField<float>& phi, const SolidBoundary& solids);

}  // namespace spume::fluid
