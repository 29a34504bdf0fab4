#include "coupling/time_step.h"

#include <algorithm>
#include <cmath>

namespace spume::coupling {

double sharedTimeStep(const TimeSpec& time, double liquidDt, double remaining) {
  const double wanted = std::clamp(liquidDt, time.minDt, time.maxDt);
  // A frame that is a whole number of steps up to round-off must not be given one more.
  const double kRoundOff = 1e-9;
  return remaining / std::max(1.0, std::ceil(remaining / wanted - kRoundOff));
}

}  // namespace spume::coupling
