#pragma once

#include "fluid/dense_field.h"
#include "fluid/grid_spec.h"

namespace spume::fluid {

/// Mean curvature kappa = div(grad phi/|grad phi|) [1/m] of the level sets at the centres of cells within
/// `kCurvatureBand` of the surface, second-order central differences, limited to +-1/dx (what the grid can
/// carry); 0 elsewhere. Positive for a drop: 2/r of a ball.
void computeCurvature(const GridSpec& grid, const DenseField<float>& phi, DenseField<float>& kappa);

/// Distance from the surface within which it is known [cells].
inline constexpr double kCurvatureBand = 2;

}  // namespace spume::fluid
