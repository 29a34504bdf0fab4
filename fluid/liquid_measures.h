#pragma once

#include <Eigen/Core>

#include "fluid/dense_field.h"
#include "fluid/grid_spec.h"
#include "fluid/solid_boundary.h"

namespace spume::fluid {

/// Largest magnitude of a velocity component on the faces of liquid cells [m/s]; NaN if any is not finite.
double maxFaceSpeed(const DenseField<float>& phi, const MacVelocity& velocity);

struct LiquidEnergy {
  double kinetic = 0, potential = 0;  ///< [J]; potential is -rho g . x, so 0 at the world's origin
};

/// Energy of the liquid, `fraction` the liquid volume of each cell in units of dx^3.
LiquidEnergy liquidEnergy(const GridSpec& grid, const DenseField<float>& fraction,
                          const MacVelocity& velocity, double density, const Eigen::Vector3d& gravity);

}  // namespace spume::fluid
