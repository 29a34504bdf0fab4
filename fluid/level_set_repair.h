#pragma once

// Includes OpenVDB, which is slow to compile: only the sources that write grids include this header.
#include <openvdb/openvdb.h>

#include <cstddef>

namespace spume::fluid {

/// Level-set tools ask that the squared gradient is within 0.5..1.5 wherever the surface crosses between
/// voxels (OpenVDB's check, fifth-order differences). Sharp edges, such as those of water against glass, and
/// features finer than a voxel break that even if every value is the exact distance. Moves each offending
/// voxel by the least multiple of a twentieth of a voxel that mends it, at most one voxel, and keeps its sign
/// if any such value does; where that does not help, moves it or a neighbour to where the gradients round it
/// are best together, and in the end smooths it. Returns how many voxels
/// still offend: none for a phi that was reinitialised.
std::size_t repairLevelSet(openvdb::FloatGrid& surface);

}  // namespace spume::fluid
