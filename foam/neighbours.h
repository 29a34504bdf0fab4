#pragma once

#include <cstdint>
#include <vector>

#include "foam/foam_topology.h"

namespace spume::foam {

/// The overlapping pairs seen from each bubble: entries start[i] .. start[i + 1] - 1 belong to bubble i,
/// ordered by the neighbour's index.
struct Neighbours {
  std::vector<std::int32_t> start;  ///< n + 1
  std::vector<std::int32_t> other;  ///< the neighbour
  std::vector<std::int32_t> pair;   ///< index of the pair in FoamTopology::overlaps

  /// `pairs` sorted by (i, j), i < j, as FoamTopology has them. O(n + pairs).
  void build(std::size_t bubbles, const std::vector<OverlapPair>& pairs);

 private:
  std::vector<std::int32_t> earlier_;  ///< how many neighbours of each bubble come before it
  std::vector<std::int32_t> next_;     ///< place of the next of these, while rows fill
};

}  // namespace spume::foam
