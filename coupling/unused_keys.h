#pragma once

#include "coupling/finding_list.h"

namespace spume::coupling {

/// Notes on keys that differ from their defaults and do nothing, because another key chose a law without
/// them.
void noteUnusedKeys(const Scene& scene, FindingList& findings);

}  // namespace spume::coupling
