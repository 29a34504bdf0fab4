#pragma once

#include <string>
#include <vector>

#include "coupling/scene.h"

namespace spume::coupling {

enum class Severity { note, warning };

/// Something a user should know before running a scene.
struct Finding {
  Severity severity;
  std::string object;   ///< the key or the named object it is about
  std::string message;  ///< with figures and what to change
};

/// What `spume check` says beyond errors: bubbles and walls against the cell, jet speed against the step,
/// time-step limits against frames and CFL. Sorted: warnings first.
std::vector<Finding> lintScene(const Scene& scene);

/// A run's size, estimated before it starts.
struct CostEstimate {
  long cells = 0;
  double liquidVolume = 0;  ///< at the end [m^3]
  int stepsPerFrame = 0;
  double secondsPerFrame = 0;  ///< wall, on two cores
  double memoryBytes = 0;
  double diskBytes = 0;  ///< all caches, statistics and pictures
};
CostEstimate estimateCost(const Scene& scene);

}  // namespace spume::coupling
