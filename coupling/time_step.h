#pragma once

#include "coupling/scene.h"

namespace spume::coupling {

/// Length [s] of the next shared step: the smaller of what the two modules ask for, kept within the scene's
/// limits, and the rest of the frame split into equal steps so that no sliver is left.
/// `remaining` is the time to the end of the frame [s], > 0.
double sharedTimeStep(const TimeSpec& time, double liquidDt, double foamDt, double remaining);

}  // namespace spume::coupling
