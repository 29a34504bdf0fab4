#pragma once

// Includes OpenVDB, which is slow to compile: only the sources that read or write grids include this header.
#include <openvdb/openvdb.h>

#include "fluid/dense_field.h"
#include "fluid/grid_spec.h"
#include "fluid/liquid_state.h"

namespace spume::fluid {

/// Half-width of the narrow band of `surface` [cells], what level-set tools expect.
inline constexpr int kSurfaceBand = 3;

// Every grid: voxel (i, j, k) is cell (i, j, k), its world position the centre of the cell [m], y up. The
// cells and the low corner of the liquid's grid are kept as metadata, so that a grid reads back without the
// scene.

/// `surface`, class GRID_LEVEL_SET: phi as a narrow band [m], < 0 in liquid. Where the liquid reaches the
/// border of the grid its surface is closed there (phi is replaced by max(phi, distance to the box of the
/// grid)), because a level set that ends at an edge is none: tools would take everything beyond for air with
/// no surface in between.
openvdb::FloatGrid::Ptr surfaceGrid(const GridSpec& grid, const DenseField<float>& phi);

/// `vel` [m/s], in the liquid and `kSurfaceBand` cells round it: at cell centres (mean of the two faces), or,
/// staggered, class GRID_STAGGERED with each cell's minus faces in its vector.
openvdb::Vec3SGrid::Ptr velocityGrid(const LiquidState& liquid, bool staggered);

/// `solid`: psi [m] in every cell, > 0 in free space. A plain scalar grid: domain walls have no outside to
/// close it.
openvdb::FloatGrid::Ptr solidGrid(const GridSpec& grid, const DenseField<float>& psi);

/// The liquid's grid that `grid` was made of. Throws std::invalid_argument if it carries no such metadata.
GridSpec gridSpecOf(const openvdb::GridBase& grid);

/// phi [m] within +-kSurfaceBand cells of the surface and clamped beyond. Where the surface was closed at the
/// border, phi is continued from the cells `kSurfaceBand` further in.
DenseField<float> phiFrom(const openvdb::FloatGrid& surface);

/// Face velocities [m/s]: exact from a staggered grid, means of cell centres otherwise; 0 where `vel` is not
/// active.
MacVelocity velocityFrom(const openvdb::Vec3SGrid& velocity);

DenseField<float> psiFrom(const openvdb::FloatGrid& solid);

}  // namespace spume::fluid
