#pragma once

#include "fluid/dense_field.h"
#include "fluid/fluid_params.h"
#include "fluid/grid_spec.h"
#include "fluid/row_spans.h"

namespace spume::fluid {

/// Moves the velocity with itself: u_t + u . grad u = 0 on the faces near liquid. Holds scratch fields.
class VelocityAdvector {
 public:
  explicit VelocityAdvector(const GridSpec& grid);

  /// Advances `velocity` by dt [s] on the stretches of faces within 2 dx of liquid; other faces keep their
  /// values. Paths by the midpoint rule, kept inside the grid; macCormack adds the returned error's half and
  /// limits the result to the values it was interpolated from [Selle et al. 2008]. Ghosts of `velocity` and
  /// `phi` must be filled; those of `velocity` are refilled.
  void advance(VelocityAdvection scheme, const DenseField<float>& phi, double dt, MacVelocity& velocity);

 private:
  void forwardPass(int axis, const MacVelocity& velocity, float cellsPerSpeed);
  void correctingPass(int axis, const MacVelocity& velocity, float cellsPerSpeed);

  GridSpec grid_;
  RowSpans wet_, forwardSpans_;  ///< what the correcting and the forward pass move
  MacVelocity forward_, low_, high_, next_;
};

}  // namespace spume::fluid
