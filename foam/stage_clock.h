#pragma once

#include <algorithm>
#include <chrono>
#include <utility>
#include <vector>

#include "foam/foam_solver.h"

namespace spume::foam {

/// Notes the wall time of each stage as it ends; a name that comes again adds to its first.
class StageClock {
 public:
  explicit StageClock(std::vector<FoamStageTime>& stages) : stages_(stages), last_(Clock::now()) {}
  void end(const char* stage) {
    const auto now = Clock::now();
    const double seconds = std::chrono::duration<double>(now - std::exchange(last_, now)).count();
    const auto known = std::find_if(stages_.begin(), stages_.end(),
                                    [&](const FoamStageTime& noted) { return noted.stage == stage; });
    if (known != stages_.end())
      known->seconds += seconds;
    else
      stages_.push_back({stage, seconds});
  }

 private:
  using Clock = std::chrono::steady_clock;
  std::vector<FoamStageTime>& stages_;
  Clock::time_point last_;
};

}  // namespace spume::foam
