#pragma once

#include <cstdint>
#include <vector>

#include "foam/convex_cell.h"
#include "foam/disc_lines.h"
#include "foam/site_grid.h"

namespace spume::foam {

/// The power cell of one bubble in its inflated ball, from the nearest sites outwards: a polyhedron, which
/// most sites are seen to miss, and a disc wherever a face of it might lie outside the ball. One per thread.
class InflatedCell {
 public:
  struct Neighbour {
    std::int32_t site;  ///< number in the grid
    double distance2;   ///< of the centres, squared [m^2]
  };

  /// Finds the cell of site `s` when every r^2 grows by `inflation` [m^2]; false if it has none. The vicinity
  /// must be around the site's cell.
  bool build(std::int32_t s, double inflation, Vicinity& vicinity);
  /// Sites that may share a face with it, in no order that means anything.
  const std::vector<Neighbour>& neighbours() const { return neighbours_; }
  /// Whether neighbour k does, within the ball.
  bool sharesFace(std::size_t k);

 private:
  bool grow(Vicinity& vicinity);
  bool noneBeyond(double seen);
  void weighRing(std::int64_t ring);
  bool cutByNearest(const Vicinity& vicinity, std::size_t begin, std::size_t end);
  bool cutByHeights(const Vicinity& vicinity, std::size_t begin, std::size_t end, double from, double to);
  void addCandidates(const Vicinity& vicinity, std::size_t k, std::size_t end, double from, double to);
  bool cutBy(const Vicinity& vicinity, std::int32_t place);
  void listNeighbours();
  void collectPlanes();

  const SiteGrid* grid_ = nullptr;
  std::int32_t number_ = -1;  ///< of the site in the grid
  const SiteGrid::Site* site_ = nullptr;
  double reach_ = 0;  ///< radius of the inflated ball [m]
  ConvexCell cell_;
  SiteGrid::Worth worth_;
  /// Sites to cut by: the signed square of the height of the plane [m^2], in single precision as a number
  /// that sorts as it does, and below it the place in the vicinity.
  std::vector<std::int64_t> candidates_, sorted_;
  std::size_t count_ = 0;                     ///< of candidates
  std::vector<Neighbour> face_, neighbours_;  ///< behind each face the cell has had; of those that are left
  std::vector<ConvexCell::Face> left_;        ///< the faces that are, in the order of the neighbours
  std::vector<std::int32_t> unsure_;
  CuttingPlanes planes_;  ///< of the neighbours, in their order, once one is asked for
  bool hasPlanes_ = false;
  DiscLines disc_;
  FilmEdges edges_;  ///< of that disc
};

}  // namespace spume::foam
