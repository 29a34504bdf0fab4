#pragma once

#include <Eigen/Core>

#include "fluid/dense_field.h"
#include "fluid/marker_particles.h"

namespace spume::fluid {

/// How hard liquid meets liquid near a point: the difference between the velocities of two points of the
/// liquid within `impactReach` of `position` that only a fifth of all pairs exceed [m/s]. Where a jet plunges
/// it is the speed of the jet relative to the pool, wherever in the layer between them the point lies, and
/// single cells thrown off by a splash do not count. The reach is three cells where that is more: the layer
/// is as thick. 0 where there is no liquid.
///
/// Deviation: the model remembers the largest speed of each marker relative to the liquid below (Section 4,
/// rule 3). Those speeds are the tail of a distribution that falls by e in 0.25 m/s and depends on dx:
/// 48^3 had 0.64 of the births of 64^3. The speeds of the two streams do not depend on it.
double impactSpeed(const MarkerScene& scene, const DenseField<float>& phi, const MacVelocity& velocity,
                   const Eigen::Vector3d& position);

}  // namespace spume::fluid
