#pragma once

#include <cstdint>
#include <vector>

#include "foam/neighbours.h"
#include "foam/row_boxes.h"
#include "foam/topology_part.h"
#include "foam/wall_cells.h"

namespace spume::foam {

/// Measures anew what some balls of a foam have changed, at the cost of their surroundings alone, and leaves
/// its geometry as a measurement of the whole would have it, bit for bit. A ball changes its own cell and
/// those of all that it meets, before or after; these cells are whole if all balls are there that meet them,
/// and all bubbles whose planes of solids do.
class PartMeasurement {
 public:
  /// The foam as it has been measured; `walls` as WallCells::compute takes them.
  void begin(const BubbleStore& bubbles, const std::vector<NearWalls>& walls) {
    planes_.list(bubbles, walls);
  }
  /// Rows have other numbers now, in the same order: rowOf[k] is that of the former row k, -1 if it is gone.
  void renumber(const std::vector<std::int32_t>& rowOf);

  /// Brings `topology` from the last begin() or update() to these bubbles and walls. `changed`: rows that
  /// have another place or radius or are cut by other walls since, that are new or have lost somebody they
  /// met; each once. `neighbours` of the topology as it was. Rows should be near in space that are near in
  /// number.
  void update(const BubbleStore& bubbles, const std::vector<NearWalls>& walls,
              const std::vector<std::int32_t>& changed, const Neighbours& neighbours, FoamTopology& topology);

  std::size_t rows() const { return rows_.size(); }  ///< that the last update() has measured

 private:
  enum Part : std::uint8_t { elsewhere, cutting, whole };

  void markWhole(const BubbleStore& bubbles, const std::vector<std::int32_t>& changed,
                 const Neighbours& neighbours);
  void markMetByPlanes(const WallPlanes& planes);
  void markCutting(const BubbleStore& bubbles, const Neighbours& neighbours);
  void gather(const BubbleStore& bubbles, const std::vector<NearWalls>& walls);

  WallPlanes planes_, planesNow_;  ///< of solids, as last measured and as they are
  RowBoxes balls_, planeBalls_;
  std::vector<std::uint8_t> part_;  ///< of every row
  std::vector<std::uint8_t> isChanged_;
  std::vector<std::int32_t> rows_;   ///< measured, ascending
  std::vector<std::uint8_t> whole_;  ///< by place in rows_
  BubbleStore bubbles_;              ///< places, radii and ids of these rows alone
  std::vector<NearWalls> walls_;
  WallCells cells_;
  FoamTopology topology_;
  PartReplacer replacer_;
};

}  // namespace spume::foam
