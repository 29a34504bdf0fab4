#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "fluid/dense_field.h"

namespace spume::coupling {

/// The eight samples round a point and its place among them.
struct TrilinearCell {
  int corner[3];  ///< lowest of the samples
  double
      along[3];  ///< from it, in cells: 0..1 between samples, down to -0.5 or up to 1.5 beyond the outermost
};

/// Where `inCells` (from the grid's low corner) lies among the samples of a window of `size` points, the
/// first of which sits at `first` cells. Every size must be at least 2. With `ghosts` the layer of ghosts on
/// every side counts, too.
inline TrilinearCell locate(const Eigen::Vector3i& size, const Eigen::Vector3d& first,
                            const Eigen::Vector3d& inCells, bool ghosts = false) {
  TrilinearCell cell;
  for (int axis = 0; axis < 3; ++axis) {
    const double place = inCells[axis] - first[axis];
    cell.corner[axis] =
        std::clamp(static_cast<int>(std::floor(place)), ghosts ? -1 : 0, size[axis] - (ghosts ? 1 : 2));
    cell.along[axis] = place - cell.corner[axis];
  }
  return cell;
}

/// The eight samples of `field` round a cell; bits 2, 1, 0 of the index step along x, y, z.
struct TrilinearSamples {
  double value[8];

  TrilinearSamples(const fluid::DenseField<float>& field, const TrilinearCell& cell) {
    const float* corner = field.data() + field.index(cell.corner[0], cell.corner[1], cell.corner[2]);
    for (int i = 0; i < 8; ++i)
      value[i] = corner[(i >> 2) * field.stride(0) + (i >> 1 & 1) * field.stride(1) + (i & 1)];
  }

  double interpolate(const TrilinearCell& cell) const {
    double face[4];
    for (int i = 0; i < 4; ++i) face[i] = mix(value[i], value[i + 4], cell.along[0]);
    return mix(mix(face[0], face[2], cell.along[1]), mix(face[1], face[3], cell.along[1]), cell.along[2]);
  }

  /// Derivative of the interpolant, per cell.
  Eigen::Vector3d gradient(const TrilinearCell& cell) const {
    Eigen::Vector3d gradient;
    for (int axis = 0; axis < 3; ++axis) {
      const int step = 4 >> axis, a = axis == 0 ? 1 : 0, b = axis == 2 ? 1 : 2;
      const int stepA = 4 >> a, stepB = 4 >> b;
      const auto slope = [&](int i) { return value[i + step] - value[i]; };
      gradient[axis] = mix(mix(slope(0), slope(stepA), cell.along[a]),
                           mix(slope(stepB), slope(stepA + stepB), cell.along[a]), cell.along[b]);
    }
    return gradient;
  }

  static double mix(double a, double b, double t) { return a + (b - a) * t; }
};

/// Weights of the eight samples, in the order of TrilinearSamples.
inline void trilinearWeights(const TrilinearCell& cell, double (&weight)[8]) {
  for (int i = 0; i < 8; ++i) {
    weight[i] = 1;
    for (int axis = 0; axis < 3; ++axis)
      weight[i] *= i >> (2 - axis) & 1 ? cell.along[axis] : 1 - cell.along[axis];
  }
}

/// Where the samples of a grid begin, in cells from its low corner: at the first cell's centre, or on its
/// minus face across `axis`.
inline Eigen::Vector3d firstCentre() { return Eigen::Vector3d::Constant(0.5); }
inline Eigen::Vector3d firstFace(int axis) { return firstCentre() - 0.5 * Eigen::Vector3d::Unit(axis); }

/// `field`, the first sample of which sits at `first`, at `inCells`; both from the grid's low corner.
inline double interpolateAt(const fluid::DenseField<float>& field, const Eigen::Vector3d& first,
                            const Eigen::Vector3d& inCells) {
  const TrilinearCell cell = locate(field.size(), first, inCells);
  return TrilinearSamples(field, cell).interpolate(cell);
}

/// Velocity [m/s] at `inCells` from the grid's low corner, each component from its own faces.
inline Eigen::Vector3d faceVelocityAt(const fluid::MacVelocity& velocity, const Eigen::Vector3d& inCells) {
  Eigen::Vector3d value;
  for (int axis = 0; axis < 3; ++axis) value[axis] = interpolateAt(velocity[axis], firstFace(axis), inCells);
  return value;
}

}  // namespace spume::coupling
