#pragma once

#include <Eigen/Core>
#include <functional>
#include <random>

#include "fluid/dense_field.h"
#include "fluid/grid_spec.h"
#include "fluid/solid_boundary.h"

namespace spume::fluid::testing {

/// n^3 cells of a box of edge 0.16 m, its corner at 0.
inline GridSpec boxGrid(int n) { return {Eigen::Vector3i::Constant(n), 0.16 / n, Eigen::Vector3d::Zero()}; }

inline DomainWalls sealed() { return {{true, true, true, true, true, true}}; }

/// `f` at the cell centres, ghosts included.
inline DenseField<float> sampleCells(const GridSpec& grid,
                                     const std::function<double(const Eigen::Vector3d&)>& f) {
  DenseField<float> field(grid.cells);
  for (int i = -kGhost; i < grid.cells.x() + kGhost; ++i)
    for (int j = -kGhost; j < grid.cells.y() + kGhost; ++j)
      for (int k = -kGhost; k < grid.cells.z() + kGhost; ++k)
        field(i, j, k) = static_cast<float>(f(grid.cellCentre(i, j, k)));
  return field;
}

/// Calls body(axis, face) for every face of the grid.
template <typename Body>
void forEachFace(const GridSpec& grid, const Body& body) {
  for (int a = 0; a < 3; ++a) {
    const Eigen::Vector3i size = grid.cells + Eigen::Vector3i::Unit(a);
    for (int i = 0; i < size.x(); ++i)
      for (int j = 0; j < size.y(); ++j)
        for (int k = 0; k < size.z(); ++k) body(a, Eigen::Vector3i(i, j, k));
  }
}

/// Independent velocities, uniform in +-`amplitude` [m/s].
inline MacVelocity randomVelocity(const GridSpec& grid, double amplitude, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(-static_cast<float>(amplitude),
                                                static_cast<float>(amplitude));
  MacVelocity velocity(grid.cells);
  forEachFace(grid, [&](int a, const Eigen::Vector3i& c) { velocity[a](c) = uniform(random); });
  return velocity;
}

inline SolidObject sphere(const Eigen::Vector3d& centre, double radius) {
  return {
      "sphere", [=](const Eigen::Vector3d& x, double) { return (x - centre).norm() - radius; }, {}, false};
}

}  // namespace spume::fluid::testing
