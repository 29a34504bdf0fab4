#pragma once

#include <cstddef>

#include "fluid/dense_field.h"

namespace spume::fluid {

/// Level-set tools ask that the squared gradient is within 0.5..1.5 wherever the surface crosses between
/// voxels (OpenVDB's check: fifth-order differences, upwind as Godunov's flux is). Sharp edges, such as those
/// of water against glass, and features finer than a voxel break that even if every value is the exact
/// distance. Moves each offending voxel by the least multiple of 1/24 voxel that mends it, at most one voxel,
/// and keeps its sign if any such value does; where that does not help, moves it or a neighbour to where the
/// gradients round it are best together, and in the end smooths it.
///
/// `phi` [m]: on voxels `dx` apart, ghost layers filled; those with abs(phi) < `band` are the narrow band,
/// the others stay as they are. Returns how many voxels still offend: none for a phi that was reinitialised.
std::size_t repairLevelSet(DenseField<float>& phi, double dx, float band);

}  // namespace spume::fluid
