#pragma once

#include <Eigen/Core>
#include <vector>

#include "foam/foam_params.h"

namespace spume::foam {

/// Drag coefficient C_D of a bubble of diameter d [m] moving at `speed` [m/s] (accuracy, 3.1; Tomiyama 1998):
/// contaminated max(24/Re (1 + 0.15 Re^0.687), 8/3 Eo/(Eo + 4)), clean max(min(16/Re (...), 48/Re), 8/3
/// Eo/(Eo + 4)).
double dragCoefficientAt(const FoamParams& params, double diameter, double speed);

/// Speed at which drag and buoyancy of a lone bubble balance in still liquid [m/s].
double terminalSpeed(const FoamParams& params, double diameter);

/// c of Eq. 3 as a function of the radius [kg/m^3]: constant, or 0.5 pi rho C_D with C_D taken at the
/// terminal speed of that size. The laws of terminal speed are tabulated once, because solving for it costs
/// more than a bubble's step.
class DragLawTable {
 public:
  explicit DragLawTable(const FoamParams& params);
  double operator()(double radius) const;

 private:
  double constant_ = 0;
  double constantBelow_ = 0;            ///< radius up to which the constant holds [m]
  std::vector<double> logCoefficient_;  ///< at radii spaced evenly in ln r
};

/// Linear drag of a bubble afloat [kg/s], Stokes' 6 pi mu r (4 pi mu r if clean) times the immersed share.
/// Deviation: Eq. 3 is quadratic alone, and then a floating bubble never comes to rest: its drift dies as m /
/// (k t). Only bubbles at the surface get this term; in the deep it would change the terminal speed.
double viscousDragFactor(const FoamParams& params, double radius, double immersed);

/// Force -k |w| w of a slip w = v - u [N], k = chi c r^2 [kg/m].
Eigen::Vector3d dragForce(double k, const Eigen::Vector3d& slip);

/// Slip [m/s] after dt [s] of mass m [kg] under a constant force F [N] and this drag: the exact solution
/// (v_t tanh(a_0 t / v_t) from rest) when the slip starts along F or F = 0, first order in dt otherwise.
Eigen::Vector3d slipAfter(const Eigen::Vector3d& slip, const Eigen::Vector3d& force, double k, double mass,
                          double dt);

/// d force / d v = -k (|w| I + w w^T / |w|) [kg/s], averaged over the slips from `from` to `to`: the slope of
/// the chord between them.
Eigen::Matrix3d meanDragJacobian(double k, const Eigen::Vector3d& from, const Eigen::Vector3d& to);

}  // namespace spume::foam
