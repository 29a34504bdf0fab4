#pragma once

#include "fluid/dense_field.h"
#include "fluid/extrapolation.h"
#include "fluid/fluid_params.h"
#include "fluid/liquid_state.h"
#include "fluid/solid_boundary.h"
#include "fluid/velocity_advection.h"

namespace spume::fluid {

/// Makes advection before projection second order in time. Alone it leaves out how the acceleration
/// a = g - grad p/rho changes along a path, which acts like a viscosity of first order in dt. Here
/// u* = A(u + dt/2 a) - dt/2 a, A the advection and a that of the last projection: with the projection's own
/// dt a at the path's end this is the trapezoidal rule. Liquid that does not move is left as it is. The
/// pressure of an impact is carried along, too: where liquid strikes liquid, velocities overshoot by a fifth.
class PathAcceleration {
 public:
  explicit PathAcceleration(const GridSpec& grid) : acceleration_(grid.cells), carried_(grid.cells) {}

  /// Takes a from the state as the last sub-step left it and continues it beyond the surface; 0 on the faces
  /// of solids and inflows. `surfaceStands`: nothing has moved since the velocity was continued there.
  void find(const LiquidState& state, const SolidBoundary& solids, const FluidParams& params,
            VelocityExtrapolator& extrapolator, bool surfaceStands);

  /// Advances `velocity` by dt [s] by VelocityAdvector::advance.
  void advect(const DenseField<float>& phi, double dt, VelocityAdvector& advector, MacVelocity& velocity);

 private:
  MacField<float> acceleration_;  ///< [m/s^2]
  MacVelocity carried_;           ///< [m/s]
};

}  // namespace spume::fluid
