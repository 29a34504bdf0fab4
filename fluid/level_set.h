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
