#pragma once

#include <cstddef>
#include <string>

#include "coupling/bubble_table.h"
#include "foam/foam_topology.h"

namespace spume::coupling {

/// Writes `id,volume,free_area,film_area,films,hidden`: a row per bubble in the order of the table, SI, 17
/// significant digits, `films` their number, `hidden` 0 or 1. Atomic. Throws FileError.
void writeCellTable(const std::string& path, const BubbleTable& bubbles, const foam::FoamTopology& topology);

/// Writes `id_a,id_b,distance,film_area`: a row per film with id_a < id_b, ordered by them, SI, 17
/// significant digits. Atomic. Throws FileError.
void writeContactTable(const std::string& path, const BubbleTable& bubbles,
                       const foam::FoamTopology& topology);

/// Sums over a foam.
struct FoamTotals {
  std::size_t bubbles = 0, hidden = 0, contacts = 0;
  double volume = 0;    ///< of the union of the balls [m^3]
  double freeArea = 0;  ///< of its surface [m^2]
  double filmArea = 0;  ///< of the films, each counted once [m^2]
};
FoamTotals totalsOf(const foam::FoamTopology& topology);

}  // namespace spume::coupling
