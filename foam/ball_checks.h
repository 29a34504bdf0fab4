#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "foam/errors.h"
#include "foam/parallel.h"

namespace spume::foam {

/// Throws InvalidParameter in the name of `who` if the lengths differ, or a position or radius is not finite
/// or a radius not positive.
inline void checkBalls(const std::string& who, const std::vector<Eigen::Vector3d>& position,
                       const std::vector<double>& radius, const std::vector<std::uint64_t>& id) {
  if (radius.size() != position.size() || id.size() != position.size())
    throw InvalidParameter(who + ": " + std::to_string(position.size()) + " positions, " +
                           std::to_string(radius.size()) + " radii and " + std::to_string(id.size()) +
                           " ids; give as many of each");
  const auto isBall = [&](std::size_t i) {
    return radius[i] > 0 && std::isfinite(radius[i]) && position[i].allFinite();
  };
  if (reduceIndices(radius.size(), true, isBall, std::logical_and<>())) return;
  for (std::size_t i = 0; i < radius.size(); ++i)
    if (!isBall(i))
      throw InvalidParameter(who + ": bubble " + std::to_string(id[i]) + " has radius " +
                             std::to_string(radius[i]) +
                             " m; it must be positive, and radius and position finite");
}

}  // namespace spume::foam
