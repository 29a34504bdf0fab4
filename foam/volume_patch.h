#pragma once

#include <cstdint>
#include <vector>

#include "foam/foam_params.h"
#include "foam/neighbours.h"
#include "foam/topology_part.h"
#include "foam/wall_cells.h"

namespace spume::foam {

/// Brings the few cells that do not hold their gas yet to do so, at the cost of their surroundings alone:
/// they and their neighbours are corrected, those around them are watched, and what cuts these is measured
/// along. Cells that appear, vanish or change their neighbours need several more Newton steps than all
/// others; each step is taken around what the last one has left or disturbed.
class VolumePatch {
 public:
  /// Corrects radii and clamped flags until all cells hold their gas to the tolerance, or no step helps any
  /// more. `topology` and `neighbours` as measured with all bubbles, volumes noted; leaves the topology and
  /// the bubbles as they are with the new radii, the neighbours as they were before the last step. `walls`
  /// may be empty. False if a ball has grown into one that was not its
  /// neighbour: then geometry has to be measured with all bubbles again.
  bool settle(const FoamParams& params, const std::vector<NearWalls>& walls, FoamTopology& topology,
              Neighbours& neighbours, BubbleStore& bubbles);

 private:
  /// Distance of a bubble from those off, in neighbours.
  enum Ring : char { elsewhere, corrected, watched, cutting };

  void choose(const std::vector<std::int32_t>& off, const Neighbours& neighbours, std::size_t bubbles);
  void gather(const std::vector<NearWalls>& walls, const BubbleStore& bubbles);
  void correct(const FoamParams& params, const FoamTopology& topology, const Neighbours& neighbours);
  void giveBack(FoamTopology& topology, BubbleStore& bubbles);
  bool hasAllPairs(const std::vector<OverlapPair>& pairs, const BubbleStore& bubbles);

  std::vector<Ring> ring_;           ///< of every bubble
  std::vector<std::int32_t> place_;  ///< in the patch, of every bubble, or -1
  std::vector<std::int32_t> rows_;   ///< of the patch, ascending
  std::vector<char> fixed_;          ///< by place in rows_: does not change itself
  std::vector<std::uint8_t> whole_;  ///< by place in rows_: has all its neighbours in the patch
  std::vector<std::int32_t> known_;  ///< overlaps of every bubble, at the end
  std::vector<double> radius_;       ///< of all bubbles when geometry was measured with all [m]
  BubbleStore part_;
  std::vector<NearWalls> walls_;
  WallCells cells_;
  FoamTopology topology_;
  Neighbours neighbours_;
  PartReplacer replacer_;
};

}  // namespace spume::foam
