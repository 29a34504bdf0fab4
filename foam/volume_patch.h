#pragma once

#include <cstdint>
#include <vector>

#include "foam/foam_params.h"
#include "foam/neighbours.h"
#include "foam/wall_cells.h"

namespace spume::foam {

/// Brings the few cells that do not hold their gas yet to do so, at the cost of their surroundings alone:
/// they and their neighbours are corrected, those around them are watched, and what cuts these is measured
/// along. Cells that appear, vanish or change their neighbours need several more Newton steps than all others.
class VolumePatch {
 public:
  /// Corrects radii and clamped flags of `off` (rows, ascending), of their neighbours, and of whom these
  /// disturb. `neighbours` and `walls` as last measured with all bubbles; `walls` may be empty.
  void settle(const FoamParams& params, const std::vector<std::int32_t>& off, const Neighbours& neighbours,
              const std::vector<NearWalls>& walls, BubbleStore& bubbles);

 private:
  /// Distance of a bubble from those off, in neighbours.
  enum Ring : char { elsewhere, corrected, watched, cutting };

  void choose(const std::vector<std::int32_t>& off, const Neighbours& neighbours, std::size_t bubbles);
  void gather(const std::vector<NearWalls>& walls, const BubbleStore& bubbles);
  void measure();
  void correct(const FoamParams& params);
  void giveBack(BubbleStore& bubbles) const;
  std::vector<std::int32_t> cellsOffIn(Ring last, double tolerance) const;

  std::vector<Ring> ring_;          ///< of every bubble
  std::vector<std::int32_t> rows_;  ///< of the patch, ascending
  std::vector<char> fixed_;         ///< by place in rows_: does not change itself
  BubbleStore part_;
  std::vector<NearWalls> walls_;
  WallCells cells_;
  FoamTopology topology_;
};

}  // namespace spume::foam
