#pragma once

#include "foam/foam_params.h"

namespace spume::foam {

/// Pull of a solid on a floating bubble at distance psi [m] [N], > 0 towards the solid, before its surface
/// weight; 0 beyond kAttractionRange. capillary: f cot(contactAngle) exp(-psi / L_c), the slope of the
/// meniscus times the bubble's load: a wetting solid attracts, a non-wetting one repels; coefficient: beta /
/// max(psi, r) [Busaryev 2012, Eq. 8]. Deviation: Eq. 8 divides by psi, which is 0 at the wall, and its beta
/// throws small bubbles about: here it shrinks with r^3 below 1.5 mm.
double solidAttraction(const FoamParams& params, const SolidSurface& solid, double gas, double radius,
                       double psi);

}  // namespace spume::foam
