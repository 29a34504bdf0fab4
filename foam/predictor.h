#pragma once

#include <Eigen/Core>

#include "foam/lone_bubble.h"

namespace spume::foam {

/// Velocity [m/s] after a step of dt [s] of a bubble without neighbours and walls (model, "Stable by
/// construction"). Deep in the liquid, where only drag depends on the motion, it is the exact solution. At
/// the surface it is a nonlinear backward Euler step m (v1 - v0) = dt F(x0 + dt v1, v1), whose equation along
/// grad phi is monotone in v and solved by safeguarded Newton: a bubble can neither overshoot its terminal
/// speed nor fly past the surface, whatever dt is.
Eigen::Vector3d predictVelocity(const LoneBubble& bubble, double dt);

/// The lone bubble's motion for the coupled solve: `matrix` (v - velocity) = impulses of the neighbours.
struct LinearMotion {
  Eigen::Vector3d velocity;  ///< v*, the prediction [m/s]
  Eigen::Matrix3d matrix;  ///< M - dt df/dv - dt^2 df/dx between v0 and v*, symmetric positive definite [kg]
};

/// Deviation: [Busaryev 2012, Eq. 9] linearises at the start of the step. Here the outer forces enter by the
/// chord between the bubble's old velocity v0 and its prediction v*: a bubble left alone moves exactly as
/// predicted, and one held in place or carried steadily by its neighbours needs exactly the impulse dt F(v0)
/// to stay so. A tangent at the prediction would push a held bubble with twice its buoyancy.
LinearMotion linearise(const LoneBubble& bubble, const Eigen::Vector3d& predicted, double dt);

}  // namespace spume::foam
