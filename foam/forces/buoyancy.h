#pragma once

#include <Eigen/Core>

#include "foam/foam_params.h"

namespace spume::foam {

/// chi: share of a sphere of radius r [m] below a plane at signed distance phi [m] from its centre (phi < 0:
/// the centre is in the liquid). 1 for phi <= -r, 0 for phi >= r.
double immersedFraction(double phi, double radius);

/// d chi / d phi [1/m], <= 0.
double immersedFractionSlope(double phi, double radius);

/// Force on a fully immersed bubble holding `gas` [m^3]; the buoyancy of Eq. 4 is chi times this [N].
/// Deviation: Eq. 4 prints a scalar; here -rho g V0, or -V0 grad p so that a falling jet gives no lift.
Eigen::Vector3d fullBuoyancy(const FoamParams& params, double gas, const Eigen::Vector3d& gradPressure);

}  // namespace spume::foam
