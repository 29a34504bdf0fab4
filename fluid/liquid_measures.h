#pragma once

#include <Eigen/Core>

#include "fluid/dense_field.h"
#include "fluid/grid_spec.h"
#include "fluid/liquid_state.h"
#include "fluid/solid_boundary.h"

namespace spume::fluid {

/// Largest magnitude of a velocity component on the faces of liquid cells [m/s]; NaN if any is not finite.
double maxFaceSpeed(const DenseField<float>& phi, const MacVelocity& velocity);

/// Mean of a cell's faces [m/s].
Eigen::Vector3d cellVelocity(const MacVelocity& velocity, const Eigen::Vector3i& cell);

/// The velocity of a state at its own time: what it leads by, times the acceleration g - grad p/rho of the
/// last projection, is taken back on the open faces of liquid cells; no further than the time `advance` [s]
/// that acceleration acted, because that of an impact says nothing of the time before. Writes no ghosts.
void presentVelocity(const LiquidState& state, const SolidBoundary& boundary, double advance, double density,
                     const Eigen::Vector3d& gravity, MacVelocity& velocity);

struct LiquidEnergy {
  double kinetic = 0, potential = 0;  ///< [J]; potential is -rho g . x, so 0 at the world's origin
};

/// Energy of the liquid, `fraction` the liquid volume of each cell in units of dx^3.
LiquidEnergy liquidEnergy(const GridSpec& grid, const DenseField<float>& fraction,
                          const MacVelocity& velocity, double density, const Eigen::Vector3d& gravity);

/// Energy of drops in flight.
LiquidEnergy energyOf(const std::vector<Drop>& drops, double density, const Eigen::Vector3d& gravity);

}  // namespace spume::fluid
