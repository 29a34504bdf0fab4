#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "foam/bubble_store.h"
#include "foam/liquid_sampler.h"

namespace spume::foam {

/// Deepest place of a bubble's centre in a solid at the end of a step [r]; touching bubbles that adhere rest
/// with their centre on the wall.
inline constexpr double kDeepestInSolid = 0.1;

/// Takes bubbles that ended a step deeper in a solid out to that depth, and from their velocity what goes
/// further in. Returns how many there were; `psi` becomes that of all bubbles where they then are [m].
///
/// Deviation: wall contact is a spring on the walls within a bubble's reach. One that its neighbours throw at
/// a wall from beyond, or that a fast solid runs over, would otherwise spend a step inside.
std::size_t keepOutOfSolids(const LiquidSampler& liquid, BubbleStore& bubbles, Eigen::VectorXd& psi);

}  // namespace spume::foam
