#pragma once

#include "fluid/dense_field.h"
#include "fluid/grid_spec.h"
#include "fluid/wall_sides.h"

namespace spume::fluid {

/// Mean curvature kappa = div(grad phi/|grad phi|) [1/m] of the level sets at the centres of cells within
/// `kCurvatureBand` of the surface, second-order central differences, limited to +-1/dx (what the grid can
/// carry); 0 elsewhere. Positive for a drop: 2/r of a ball. Beside a thin wall a cell does not see what is on
/// the other side: a vessel's own surface would bend to the level outside it.
void computeCurvature(const GridSpec& grid, const WallSides& sides, const DenseField<float>& phi,
                      DenseField<float>& kappa);

/// Distance from the surface within which it is known [cells].
inline constexpr double kCurvatureBand = 2;

}  // namespace spume::fluid
