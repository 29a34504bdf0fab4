#pragma once

#include "fluid/dense_field.h"
#include "fluid/fluid_params.h"
#include "fluid/grid_spec.h"

namespace spume::fluid {

/// Moves the velocity with itself: u_t + u . grad u = 0 on the faces near liquid. Holds scratch fields.
class VelocityAdvector {
 public:
  explicit VelocityAdvector(const GridSpec& grid);

  /// Advances `velocity` by dt [s] on the faces within reach of liquid (phi < kAdvectReach dx on either
  /// side); other faces keep their values. Ghosts of `velocity` must be filled and are refilled.
  void advance(VelocityAdvection scheme, const DenseField<float>& phi, double dt, MacVelocity& velocity);

 private:
  void traceAxis(int axis, const DenseField<float>& phi, const MacVelocity& velocity, float cellsPerSpeed,
                 float reach, const DenseField<float>& source, DenseField<float>& out) const;
  void correctAxis(int axis, const DenseField<float>& phi, const MacVelocity& velocity, float cellsPerSpeed,
                   float reach, DenseField<float>& out) const;

  GridSpec grid_;
  MacVelocity forward_, next_;
};

}  // namespace spume::fluid
