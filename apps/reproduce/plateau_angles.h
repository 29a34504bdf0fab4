#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "foam/film_network.h"
#include "foam/foam_topology.h"

namespace spume::apps {

/// Plateau's angles of a froth: three films meet in a border at 120 degrees, four borders in a point at
/// acos(-1/3), about 109.47 degrees.
struct PlateauAngles {
  std::vector<double> films;    ///< between the films of every border, three each [degrees]
  std::vector<double> borders;  ///< between the borders of every point, six each [degrees]
  std::vector<std::array<std::int32_t, 3>> bordersCells;  ///< the bubbles that meet in each border
  std::vector<std::array<std::int32_t, 4>> pointsCells;   ///< and in each point

  double filmSpread() const;    ///< rms difference from 120 degrees; NaN without borders
  double borderSpread() const;  ///< rms difference from acos(-1/3); NaN without points
};

/// Measures the plane films of a power diagram restricted to its balls: borders and points all of whose
/// bubbles are `wanted` (one flag a bubble). `topology` is that of the balls. O(films x neighbours^2).
PlateauAngles plateauAngles(const std::vector<Eigen::Vector3d>& position, const std::vector<double>& radius,
                            const foam::FoamTopology& topology, const std::vector<std::uint8_t>& wanted);

/// The same of a network of films: films at every stretch of a border, borders by their stretches next to the
/// point. `bordersCells` has an entry a stretch.
PlateauAngles plateauAngles(const foam::FilmNetwork& network, const std::vector<std::uint8_t>& wanted);

/// The angles that the same borders and points would have with every pair of their bubbles at Plateau's
/// distance, l^2 = r_i^2 + r_j^2 - r_i r_j: round films would meet at 120 degrees there, plane ones of
/// unequal bubbles do not. What a froth spreads by beyond that, its bubbles' many neighbours force on it:
/// even equal ones in Kelvin's order spread by 7.4 (films) and 14.1 (borders) degrees. Points that cannot be
/// built of such lengths are left out.
PlateauAngles anglesAtRest(const std::vector<double>& radius, const PlateauAngles& measured);

/// Number of borders around every film of the topology; what is left of the film's rim, the free part of its
/// disc, is none. O(films x neighbours^2).
std::vector<int> bordersOfFilms(const std::vector<Eigen::Vector3d>& position,
                                const std::vector<double>& radius, const foam::FoamTopology& topology);

}  // namespace spume::apps
