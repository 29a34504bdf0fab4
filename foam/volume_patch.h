#pragma once

#include <cstdint>
#include <vector>

#include "foam/foam_params.h"
#include "foam/neighbours.h"
#include "foam/wall_cells.h"

namespace spume::foam {

/// Brings the few cells that do not hold their gas yet to do so, at the cost of their surroundings alone:
/// they and their neighbours are corrected, and what cuts these is measured along. Cells that appear, vanish
/// or change their neighbours need several more Newton steps than all others.
class VolumePatch {
 public:
  /// Corrects radii and clamped flags of `off` (rows, ascending) and of their neighbours. `neighbours` and
  /// `walls` as last measured with all bubbles; `walls` may be empty.
  void settle(const FoamParams& params, const std::vector<std::int32_t>& off, const Neighbours& neighbours,
              const std::vector<NearWalls>& walls, BubbleStore& bubbles);

 private:
  void choose(const std::vector<std::int32_t>& off, const Neighbours& neighbours, std::size_t bubbles);

  std::vector<std::int32_t> rows_;  ///< of the patch, ascending
  std::vector<char> fixed_;         ///< by place in rows_: cuts others, does not change itself
  std::vector<char> ring_;          ///< by row of all bubbles: 1 corrected, 2 fixed, 0 not in the patch
  BubbleStore part_;
  std::vector<NearWalls> walls_;
  WallCells cells_;
  FoamTopology topology_;
};

}  // namespace spume::foam
