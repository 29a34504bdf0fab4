#pragma once

#include <Eigen/Core>

#include "fluid/solid_boundary.h"

namespace spume::fluid {

/// A wall thinner than a cell's diagonal can split a cell: free corners on both sides of it, joined by no
/// edge of the cell. Each such cell keeps the part with the larger opening; faces are closed towards the
/// other, and `cellFraction` is left with what is kept. Two free corners that are joined by an edge have no
/// wall of one cell between them, so after this no path of open faces crosses such a wall.
void closeSplitCells(const Eigen::Vector3i& cells, SolidBoundary& boundary);

}  // namespace spume::fluid
