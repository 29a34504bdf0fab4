#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace spume::fluid {

/// Liquid too fine for the grid, in free flight.
struct Drop {
  Eigen::Vector3d position;  ///< [m]
  Eigen::Vector3d velocity;  ///< [m/s]
  double volume;             ///< [m^3]
  std::uint64_t id = 0;      ///< unique in a run
};

}  // namespace spume::fluid
