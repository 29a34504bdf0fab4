#pragma once

#include "coupling/finding_list.h"

namespace spume::coupling {

/// Solids that are thin, overlap, never touch the grid, or move faster than steps can follow.
void lintSolids(const Scene& scene, FindingList& findings);

}  // namespace spume::coupling
