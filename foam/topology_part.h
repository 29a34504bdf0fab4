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
  /// What the pairs of some rows, one after the other, are put together from, and where they go.
  struct Piece {
    std::size_t known, fresh;     ///< first pair of the whole, and of the part
    std::size_t overlaps, films;  ///< first place; how many, while they are counted
  };
  /// What is put together.
  struct Sources {
    const FoamTopology &all, &part;
    const std::vector<std::int32_t>& rows;
    const std::vector<std::uint8_t>& whole;
  };

  void takeColumns(const Sources& from, FoamTopology& all);
  void cutPieces(const Sources& from);
  template <typename Keep>
  void merge(const Sources& from, std::size_t piece, const Keep& keep) const;
  void write(const Sources& from, std::size_t piece);

  std::vector<std::uint8_t> isWhole_;  ///< by row of the foam
  std::vector<Piece> pieces_;          ///< and the end of the last
  std::vector<OverlapPair> overlaps_;
  std::vector<Film> films_;
};

}  // namespace spume::foam
