#pragma once

#include "fluid/marker_particles.h"
#include "tests/support/fluid_fields.h"

namespace spume::fluid::test {

/// A domain of free space with a level set and markers on both sides.
struct Pool {
  GridSpec grid;
  FluidParams params;
  DomainWalls walls;
  SolidBoundary solids;
  DenseField<float> phi;
  MarkerSet positive, negative;

  Pool(int n, const ScalarFunction& phi0, const DomainWalls& w = closedWalls())
      : grid(unitCube(n)), walls(w), solids(buildSolidBoundary(grid, w, {}, 0)), phi(levelSet(grid, phi0)) {}

  MarkerScene scene() const { return {grid, params, walls, solids}; }
  void seed(std::int64_t subStep = 0) {
    MarkerSeeder(grid).reseed(scene(), phi, subStep, positive, negative);
  }
};

inline double flat(const Eigen::Vector3d& x) { return x.y() - 0.5; }
inline double sphere(const Eigen::Vector3d& x) { return (x - Eigen::Vector3d(0.5, 0.5, 0.5)).norm() - 0.25; }

}  // namespace spume::fluid::test
