#pragma once

#include "fluid/dense_field.h"
#include "fluid/fluid_params.h"
#include "fluid/grid_spec.h"
#include "fluid/row_spans.h"

namespace spume::fluid {

/// Moves a velocity, or what is given like one, with the liquid: q_t + u . grad q = 0 on the faces near
/// liquid. Holds scratch fields.
class VelocityAdvector {
 public:
  explicit VelocityAdvector(const GridSpec& grid);

  /// Advances `carried` by dt [s] with `velocity` on the stretches of faces within 2 dx of liquid; other
  /// faces keep their values. Paths by the midpoint rule, kept inside the grid; all but semiLagrangian
  /// add the returned error's half and limit the result to the values it was interpolated from [Selle et al.
  /// 2008], except next to the surface. Ghosts of all fields must be filled; those of `carried` are refilled.
  void advance(VelocityAdvection scheme, const DenseField<float>& phi, double dt, const MacVelocity& velocity,
               MacVelocity& carried);
  /// The velocity moves itself.
  void advance(VelocityAdvection scheme, const DenseField<float>& phi, double dt, MacVelocity& velocity) {
    advance(scheme, phi, dt, velocity, velocity);
  }

 private:
  void forwardPass(int axis, const MacVelocity& velocity, const MacVelocity& carried, float cellsPerSpeed);
  void correctingPass(int axis, const DenseField<float>& phi, const MacVelocity& velocity,
                      const MacVelocity& carried, float cellsPerSpeed);

  GridSpec grid_;
  RowSpans wet_, forwardSpans_;  ///< what the correcting and the forward pass move
  MacVelocity forward_, low_, high_, next_;
};

}  // namespace spume::fluid
