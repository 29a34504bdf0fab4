#pragma once

#include "coupling/finding_list.h"

namespace spume::coupling {

/// What the grid has no room for: edges that rounding to cells changes much, liquid bodies and drains without
/// a free cell, a domain that is all solid.
void lintRoom(const Scene& scene, FindingList& findings);

}  // namespace spume::coupling
