#pragma once

#include "foam/foam_params.h"

namespace spume::foam {

/// c_vis of the damping -(1 - chi) c_vis v of a bubble aloft [Eq. 10]: a constant, or Stokes' 6 pi mu_air r
/// [kg/s].
double airDragFactor(const FoamParams& params, double radius);

}  // namespace spume::foam
