#pragma once

#include "coupling/scene.h"

namespace spume::coupling {

/// Length [s] of the next shared step: what the liquid's CFL number allows, kept within the scene's limits,
/// and the rest of the frame split into equal steps so that no sliver is left. The foam sub-cycles inside it.
/// `remaining` is the time to the end of the frame [s], > 0.
double sharedTimeStep(const TimeSpec& time, double liquidDt, double remaining);

}  // namespace spume::coupling
