#pragma once

#include <vector>

#include "fluid/pushes.h"
#include "foam/foam_solver.h"

namespace spume::coupling {

/// Two-way coupling (model, "Coupling"): what drag gave the bubbles in a foam step is taken from the liquid, at
/// the start of its next step, before that is made free of divergence. The sum of both momenta and of the
/// impulses under way changes by the outer forces and by what fluid::Pushes withholds, which it reports.
std::vector<fluid::Push> reactions(const std::vector<foam::DragImpulse>& drag);

}  // namespace spume::coupling
