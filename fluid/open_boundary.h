#pragma once

#include "fluid/dense_field.h"
#include "fluid/grid_spec.h"
#include "fluid/solid_boundary.h"

namespace spume::fluid {

/// What flows in through an open domain face is air: where `velocity` points inwards there, phi is raised to
/// the distance from the front of the air that entered in dt [s]. Without it a liquid that touches the face
/// would pull more of itself out of nothing. Call after phi was advected with `velocity`.
void admitAir(const GridSpec& grid, const SolidBoundary& boundary, const MacVelocity& velocity, double dt,
              DenseField<float>& phi);

}  // namespace spume::fluid
