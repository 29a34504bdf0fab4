#pragma once

#include <cmath>
#include <functional>
#include <string>

#include "fluid/liquid_solver.h"

namespace spume::apps {

using Level = std::function<double(const Eigen::Vector3d&)>;
using Flow = std::function<Eigen::Vector3d(const Eigen::Vector3d&)>;

/// A box of cells for a case: plane cases are slabs a few cells thick.
inline constexpr int kSlabCells = 4;

inline fluid::GridSpec slab(int nx, int ny, double dx) { return {{nx, ny, kSlabCells}, dx, {0, 0, 0}}; }

inline fluid::DomainWalls closedBox() { return {{true, true, true, true, true, true}}; }
inline fluid::DomainWalls openTop() { return {}; }

/// A solver whose liquid starts with a given velocity.
inline fluid::LiquidSolver movingLiquid(const fluid::FluidParams& params, const fluid::LiquidSetup& setup,
                                        const Level& phi0, const Flow& flow) {
  fluid::LiquidState state = fluid::LiquidSolver(params, setup, phi0).state();
  for (int a = 0; a < 3; ++a) {
    auto& u = state.velocity[a];
    for (int i = 0; i < u.size().x(); ++i)
      for (int j = 0; j < u.size().y(); ++j)
        for (int k = 0; k < u.size().z(); ++k)
          u(i, j, k) = static_cast<float>(flow(state.grid.faceCentre(a, i, j, k))[a]);
  }
  return {params, setup, std::move(state)};
}

/// Place of the surface along `axis` in the row of cells through `at` (counted from below), by the first
/// change of sign from liquid to air; the row's start if it is dry [m].
inline double surfaceAlong(const fluid::LiquidState& state, int axis, Eigen::Vector3i at) {
  const fluid::GridSpec& grid = state.grid;
  double edge = grid.origin[axis];
  for (at[axis] = 0; at[axis] < grid.cells[axis]; ++at[axis]) {
    const double here = state.phi(at);
    if (here >= 0) break;
    const double next = state.phi(at + Eigen::Vector3i::Unit(axis));
    edge = grid.cellCentre(at.x(), at.y(), at.z())[axis] + grid.dx * (next > 0 ? here / (here - next) : 0.5);
  }
  return edge;
}

}  // namespace spume::apps
