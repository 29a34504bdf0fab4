#pragma once

#include "foam/foam_params.h"

namespace spume::foam {

/// Mass of the liquid in the films of a bubble aloft, rho V0 eps / (1 - eps) with the liquid fraction
/// eps = 0.36 lambda^2 (model, "Inertia") [kg].
double filmMass(const FoamParams& params, double gas, double wetness);

/// What gravity acts on: the gas and, above the liquid, the films [kg].
double weighedMass(const FoamParams& params, double gas, double wetness, double immersed);

/// Inertia m = rho_gas V0 + film mass (1 - chi) + C_M rho V0 chi [kg]: only inertia knows the added mass.
double inertia(const FoamParams& params, double gas, double wetness, double immersed);

}  // namespace spume::foam
