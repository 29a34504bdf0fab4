#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "foam/foam_topology.h"

namespace spume::apps {

/// Plateau's angles of a froth: three films meet in a border at 120 degrees, four borders in a point at
/// acos(-1/3), about 109.47 degrees.
struct PlateauAngles {
  std::vector<double> films;    ///< between the films of every border, three each [degrees]
  std::vector<double> borders;  ///< between the borders of every point, six each [degrees]

  double filmSpread() const;    ///< rms difference from 120 degrees; NaN without borders
  double borderSpread() const;  ///< rms difference from acos(-1/3); NaN without points
};

/// Measures the plane films of a power diagram restricted to its balls: borders and points all of whose
/// bubbles are `wanted` (one flag a bubble). `topology` is that of the balls. O(films x neighbours^2).
PlateauAngles plateauAngles(const std::vector<Eigen::Vector3d>& position, const std::vector<double>& radius,
                            const foam::FoamTopology& topology, const std::vector<std::uint8_t>& wanted);

/// Number of borders around every film of the topology; what is left of the film's rim, the free part of its
/// disc, is none. O(films x neighbours^2).
std::vector<int> bordersOfFilms(const std::vector<Eigen::Vector3d>& position,
                                const std::vector<double>& radius, const foam::FoamTopology& topology);

}  // namespace spume::apps
