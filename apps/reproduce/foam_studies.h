#pragma once

#include <vector>

#include "apps/reproduce/reproduction.h"

namespace spume::apps {

// The studies of the foam's table, by what they exercise.
std::vector<Study> loneBubbleStudies();  ///< one bubble at a time: rise, bursting, volume, a wall
std::vector<Study> clusterStudies();     ///< clusters of few bubbles and ordered foams
std::vector<Study> crowdStudies();       ///< many bubbles: momentum, rest, volumes under pressure

}  // namespace spume::apps
