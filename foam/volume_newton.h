#pragma once

#include <vector>

#include "foam/foam_topology.h"
#include "foam/neighbours.h"

namespace spume::foam {

/// The changes of all weights r^2 [m^2] that together change the volumes of the cells by `wanted` [m^3] to
/// first order: dV_i/dw_j = -A_ij / (2 d_ij), dV_i/dw_i = sum_j A_ij / (2 d_ij) + S_i / (2 r_i) (model,
/// "Derivatives"). The matrix is symmetric and diagonally dominant; conjugate gradients with its diagonal
/// solve it to `tolerance` of the right-hand side. Rows without film or free area stay 0, as do those whose
/// `fixed` is set, which cost next to nothing: their neighbours change as beside a ball of given size.
/// `neighbours` of the topology; `radius` [m]; lengths as the topology's.
void solveWeightChanges(const FoamTopology& topology, const Neighbours& neighbours,
                        const std::vector<double>& radius, const std::vector<double>& wanted,
                        const std::vector<char>& fixed, double tolerance, std::vector<double>& change);

/// What the cell of row i loses [m^3] to its neighbours, to first order, where their weights change by
/// `change` [m^2] and its own stays as it is: sum_j A_ij / (2 d_ij) dw_j.
double volumeLost(const FoamTopology& topology, const Neighbours& neighbours,
                  const std::vector<double>& change, std::size_t i);

}  // namespace spume::foam
