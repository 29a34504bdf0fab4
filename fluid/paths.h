#pragma once

#include "fluid/dense_field.h"
#include "fluid/sampling.h"

namespace spume::fluid {

/// Points traced together: positions stay in the first-level cache and the loops over them vectorise. One
/// register of the widest kind, so that a run that only grazes the liquid drags few dry points along.
inline constexpr int kPathChunk = 16;

/// Positions [cells] or velocities [m/s] of a run of points along z.
struct alignas(64) PathPoints {
  float x[kPathChunk], y[kPathChunk], z[kPathChunk];
};

/// The centres of the cells (i, j, k) to (i, j, k + kPathChunk - 1), and the wind there: the mean of each
/// cell's faces. Cells past the end of the row get some finite wind; the same below for faces.
void cellStarts(const MacVelocity& velocity, int i, int j, int k, PathPoints& centre, PathPoints& wind);

/// The same for faces across `axis`; the wind's other components are means of the four faces around.
void faceStarts(const MacVelocity& velocity, int axis, int i, int j, int k, PathPoints& centre,
                PathPoints& wind);

/// Ends of the paths from `centre` along the wind for a time of `cellsPerSpeed` dx (negative: back), midpoint
/// rule, kept inside the grid of `top` cells. `startWind` is the wind at `centre`; ghosts must be filled.
void tracePaths(const MacView& wind, const Eigen::Vector3f& top, float cellsPerSpeed,
                const PathPoints& __restrict centre, const PathPoints& __restrict startWind,
                PathPoints& __restrict end);

/// Trilinear values of a cell-centred field at a run of positions inside the grid.
void sampleRun(const FieldView& field, const PathPoints& __restrict at, float* __restrict value);

/// Largest magnitude of any component on the grid [m/s].
float largestSpeed(const MacVelocity& velocity);

}  // namespace spume::fluid
