#pragma once

#include <Eigen/Core>

#include "foam/forces/liquid_adhesion.h"

namespace spume::foam {

/// What acts on one bubble besides its neighbours, as a function of the velocity v with which it ends the
/// step: the liquid's surface is taken flat, so it ends at phi + dt v . grad phi.
struct LoneBubble {
  Eigen::Vector3d velocity;  ///< at the start of the step [m/s]
  double mass = 0;           ///< inertia [kg]
  double radius = 0;         ///< [m]
  Eigen::Vector3d weight;    ///< and every other constant force [N]

  double phi = 0, phiSlope = 0;  ///< [m], |grad phi| [-]
  Eigen::Vector3d up;            ///< unit grad phi: away from the liquid
  StepStart start = StepStart::immersed;
  double immersed = 0;             ///< chi at the start of the step [-]
  Eigen::Vector3d fullBuoyancy;    ///< at chi = 1 [N]
  double adhesion = 0;             ///< w s_lad [N/m]
  double drag = 0;                 ///< chi c r^2 [kg/m]
  double airDrag = 0;              ///< (1 - chi) c_vis [kg/s]
  double viscousDrag = 0;          ///< against the slip, for a bubble afloat [kg/s]
  Eigen::Vector3d liquidVelocity;  ///< [m/s]

  double phiAfter(const Eigen::Vector3d& v, double dt) const { return phi + dt * phiSlope * up.dot(v); }

  /// Buoyancy and liquid adhesion at a signed distance from the surface [N].
  Eigen::Vector3d surfaceForce(double phiAt) const;
  /// Its part along `up`, for a full buoyancy whose part along it is `lift` [N].
  double surfacePull(double phiAt, double lift) const;
  /// d (up . surfaceForce) / d phi [N/m], <= 0: a growing force is frozen.
  double surfaceStiffness(double phiAt) const { return surfaceStiffness(phiAt, fullBuoyancy.dot(up)); }
  double surfaceStiffness(double phiAt, double lift) const;
  /// All but the wall at the end of a step of dt [s] with velocity v [N].
  Eigen::Vector3d force(const Eigen::Vector3d& v, double dt) const;
};

}  // namespace spume::foam
