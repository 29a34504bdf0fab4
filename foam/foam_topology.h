#pragma once

#include <cstdint>
#include <vector>

namespace spume::foam {

/// Two balls that overlap: i < j, 0 <= d < r_i + r_j. `film` is the index of their film, or -1 if they have
/// none because others cover it or one ball contains the other (d <= |r_i - r_j|; d is 0 for coincident
/// centres).
struct OverlapPair {
  std::int32_t i, j;
  double distance;  ///< d [m]
  std::int32_t film;
};

/// A contact: an edge of the alpha complex at alpha = 0 with its face inside the balls, i < j.
struct Film {
  std::int32_t i, j;
  double distance;  ///< d between the centres [m], > 0
  double height;    ///< signed distance of the radical plane from x_i towards x_j [m]
  double area;      ///< of the film [m^2], >= 0 (0 only where balls touch in a point)
};

/// Geometry of the foam: what the local engine (power_cells) and the global one (power_diagram) both return.
/// Per-bubble columns are in the order of the input; lists are sorted by (i, j).
struct FoamTopology {
  std::vector<OverlapPair> overlaps;
  std::vector<Film> films;
  std::vector<double> volume;    ///< of the cell restricted to its ball [m^3], 0 if hidden
  std::vector<double> freeArea;  ///< of the ball's sphere left in the cell [m^2]
  std::vector<double> filmArea;  ///< sum over the bubble's films [m^2]
  std::vector<std::uint8_t>
      hidden;  ///< 1: the bubble has no cell: its ball lies in another or in a union of others
};

}  // namespace spume::foam
