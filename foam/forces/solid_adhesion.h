#pragma once

#include "foam/foam_params.h"

namespace spume::foam {

/// A bubble that has touched a solid lets go of it beyond this many radii (model, "solid adhesion").
inline constexpr double kLetGo = 1.5;

/// Force that keeps a touching bubble from sliding [N]: the buoyancy of the largest bubble the solid can
/// hold, rho g 4/3 pi detachRadius^3.
double pinningForce(const FoamParams& params, const SolidSurface& solid);

/// Whether a bubble that touched the solid stays on it: it does until its buoyancy chi rho g V0 exceeds the
/// pinning force, or its centre is further away than 1.5 r.
bool adheres(const FoamParams& params, const SolidSurface& solid, double gas, double radius, double immersed,
             double psi);

}  // namespace spume::foam
