#pragma once

#include <cstdint>
#include <vector>

#include "foam/foam_topology.h"
#include "foam/neighbours.h"

namespace spume::foam {

/// The geometry of some rows of a foam: their columns, and what lies between two of them. `rows` ascending,
/// `place` of every row among them or -1, `neighbours` of `all`.
void takePart(const FoamTopology& all, const Neighbours& neighbours, const std::vector<std::int32_t>& rows,
              const std::vector<std::int32_t>& place, FoamTopology& part);

/// Puts a part measured anew back into the whole, as a measurement of the whole would have it if `whole`
/// holds for every row of the part that has all its neighbours there: the columns of these rows, and the
/// pairs and films with one of them. Pairs stay sorted. Keeps scratch memory.
class PartReplacer {
 public:
  void putBack(const FoamTopology& part, const std::vector<std::int32_t>& rows,
               const std::vector<std::uint8_t>& whole, FoamTopology& all);

 private:
  void keep(const OverlapPair& pair, std::int32_t i, std::int32_t j, const FoamTopology& from);

  std::vector<std::uint8_t> isWhole_;  ///< by row of the foam
  std::vector<OverlapPair> overlaps_;
  std::vector<Film> films_;
};

}  // namespace spume::foam
