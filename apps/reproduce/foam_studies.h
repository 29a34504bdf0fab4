#pragma once

#include <vector>

#include "apps/reproduce/reproduction.h"

namespace spume::apps {

// The studies of the foam's table, by what they exercise.
std::vector<Study> loneBubbleStudies();  ///< one bubble at a time: rise, bursting, volume
std::vector<Study> attractionStudies();  ///< pulls between floating bubbles and of walls
std::vector<Study> clusterStudies();     ///< clusters of few bubbles and ordered foams
std::vector<Study> crowdStudies();       ///< many bubbles: momentum, volumes under pressure
std::vector<Study> packingStudies();     ///< foams and packings of many cells: faces, contacts, order
std::vector<Study> contactStudies();     ///< contacts of soft discs and of cells that hold their areas
std::vector<Study> restStudies();        ///< arrival at the surface, rafts and piles at rest

}  // namespace spume::apps
