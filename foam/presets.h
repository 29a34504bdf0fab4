#pragma once

#include "foam/foam_params.h"

namespace spume::foam {

/// All parameters of a named preset (model, Section 2). `paper` keeps the coefficients of [Busaryev 2012,
/// Table 1] at the values that work in SI; `physical` derives each from density, viscosity and surface
/// tension.
FoamParams makePreset(Preset preset);

}  // namespace spume::foam
