#pragma once

#include <Eigen/Core>

#include "foam/lone_bubble.h"

namespace spume::foam {

/// Velocity [m/s] after a step of dt [s] of a bubble without neighbours: nonlinear backward Euler,
/// m (v1 - v0) = dt F(x0 + dt v1, v1) (model, "Stable by construction"). Deep in the liquid or high above it
/// the slip has a closed form; at the surface the equation along grad phi is monotone in v and solved by
/// safeguarded Newton, so a bubble can neither overshoot its terminal speed nor fly past the surface,
/// whatever dt is.
Eigen::Vector3d predictVelocity(const LoneBubble& bubble, double dt);

/// The lone bubble's motion for the coupled solve: m (v - v*) - dt slope (v - v*) = impulses of the
/// neighbours.
struct LinearMotion {
  Eigen::Vector3d velocity;  ///< v*, the prediction [m/s]
  Eigen::Vector3d impulse;   ///< left over at v*: dt F(v*) - m (v* - v0) [N s]
  Eigen::Matrix3d
      slope;  ///< of the force per velocity between v0 and v*, symmetric negative semidefinite [kg/s]
};

/// Deviation: [Busaryev 2012, Eq. 9] linearises at the start of the step. Here each force enters by the chord
/// between the bubble's old velocity and its prediction: a bubble left alone moves exactly as predicted, and
/// one held in place or carried steadily by its neighbours feels exactly the force of where it is. A tangent
/// at the prediction would push a held bubble with twice its buoyancy.
LinearMotion linearise(const LoneBubble& bubble, const Eigen::Vector3d& predicted, double dt);

}  // namespace spume::foam
