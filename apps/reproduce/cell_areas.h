#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "foam/foam_topology.h"

namespace spume::apps {

/// A ball i that overlaps ball j, or an image of it.
struct Overlap {
  std::int32_t i, j;
  Eigen::Vector3d apart;  ///< from the centre of j, or of its image, to that of i
  double distance;        ///< its length, > 0
};

/// Discs of a plane whose radii follow from the areas their power cells are to have: the foam's volume
/// correction in two dimensions, by the same derivatives.
class CellAreas {
 public:
  /// `area`: of each disc's cell, > 0.
  explicit CellAreas(std::vector<double> area) : area_(std::move(area)) {}

  /// Cuts every disc by its radical lines. `overlaps`: all of disc 0, then of disc 1 and so on; `radius` of
  /// the discs, may be longer.
  void measure(const std::vector<Overlap>& overlaps, const std::vector<double>& radius);
  /// Largest departure of a cell's area from what it is to be, as a share of that.
  double worst() const;
  /// One Newton step of all radii together, from the cells as measured. No disc gets smaller than its area.
  void improve(std::vector<double>& radius) const;
  /// Length of the edge that the cells of an overlap share; 0 if others cover it.
  double edge(std::size_t overlap) const { return edge_[overlap]; }

 private:
  std::vector<double> area_, edge_;
  foam::FoamTopology cells_;  ///< in the plane: areas for volumes, lengths for areas
};

}  // namespace spume::apps
