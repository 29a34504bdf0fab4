#pragma once

#include <vector>

#include "apps/reproduce/reproduction.h"

namespace spume::apps {

// The studies of the liquid's table, by what they exercise.
std::vector<Study> transportStudies();  ///< surfaces carried by given velocities
std::vector<Study> escapeStudies();     ///< liquid too thin for the grid, carried by given velocities
std::vector<Study> exactFlowStudies();  ///< rest, free fall, vortices
std::vector<Study> waveStudies();       ///< standing waves, with and without viscosity
std::vector<Study> damBreakStudies();   ///< collapsing columns beside measurements
std::vector<Study> tensionStudies();    ///< drops held together by surface tension
std::vector<Study> tankStudies();       ///< a tank with an obstacle
std::vector<Study> fillingStudies();    ///< a box being filled, with and without bubbles

}  // namespace spume::apps
