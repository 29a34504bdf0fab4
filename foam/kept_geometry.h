#pragma once

#include <cstdint>
#include <vector>

#include "foam/part_measurement.h"

namespace spume::foam {

/// The geometry of a step's end, used again at the start of the next: then only bubbles that are new, that
/// are gone or that somebody has changed have to be measured. What comes out is what a measurement of all
/// would give, bit for bit, so nothing depends on whether there was something to keep.
class KeptGeometry {
 public:
  /// Notes what a topology has been measured of, with all planes of solids; `walls` as WallCells takes them.
  void note(const BubbleStore& bubbles, const std::vector<NearWalls>& walls);
  void forget() { isKept_ = false; }

  /// Brings the noted topology to these bubbles, rows of which are in the same order as far as they were
  /// noted, and lists their neighbours. False if nothing is noted, the order is another, or too much has
  /// changed; then neither has a meaning. Forgets what was noted.
  bool renew(const BubbleStore& bubbles, const std::vector<NearWalls>& walls, FoamTopology& topology,
             Neighbours& neighbours);

 private:
  bool matchRows(const BubbleStore& bubbles);
  void renumber(FoamTopology& topology, std::size_t bubbles);
  void dropPairs(FoamTopology& topology);
  bool isAsNoted(std::size_t former, std::size_t row, const BubbleStore& bubbles,
                 const std::vector<NearWalls>& walls) const;

  bool isKept_ = false;
  std::uint64_t nextId_ = 0;       ///< ids from here on are born since
  std::vector<std::uint64_t> id_;  ///< as noted
  std::vector<Eigen::Vector3d> position_;
  std::vector<double> radius_;
  std::vector<NearWalls> walls_;
  std::vector<std::int32_t> rowOf_;      ///< of each row noted, -1 if it is gone
  std::vector<std::uint8_t> isChanged_;  ///< of each row
  std::vector<std::int32_t> changed_;
  PartMeasurement measurement_;
};

}  // namespace spume::foam
