#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "foam/cell_hash.h"
#include "foam/radical_plane.h"

namespace spume::foam {

/// All bubbles, sorted by the cells of a grid, x fastest: sites of a power diagram that can be looked up by
/// place.
class SiteGrid {
 public:
  /// One bubble.
  struct Site {
    Eigen::Vector3d position;  ///< [m]
    TieBrokenBall ball;
    std::int32_t index;  ///< in the arrays the grid was made from
  };
  /// Sites begin .. end - 1.
  struct Run {
    std::int32_t begin = 0, end = 0;
  };

  /// Arrays of equal length n, and the edge of a cell [m, > 0]. O(n log n).
  SiteGrid(const std::vector<Eigen::Vector3d>& position, const std::vector<double>& radius,
           const std::vector<std::uint64_t>& id, double cellSize);

  double cellSize() const { return cellSize_; }
  double maxRadius() const { return maxRadius_; }
  /// The smallest box around all sites [m].
  const Eigen::Vector3d& low() const { return lowest_; }
  const Eigen::Vector3d& high() const { return highest_; }
  const std::vector<Site>& sites() const { return sites_; }
  /// First site of each cell that is not empty, then the number of sites.
  const std::vector<std::int32_t>& runStart() const { return runStart_; }

  /// Calls visit(run) for runs of the sites whose cell is `ring` cells from that of x, in the largest
  /// coordinate.
  template <typename Visit>
  void visitRing(const Eigen::Vector3d& x, std::int64_t ring, const Visit& visit) const {
    const Cell centre = cellOf(x);
    Cell cell;
    for (cell[2] = from(centre, 2, ring); cell[2] <= to(centre, 2, ring); ++cell[2])
      for (cell[1] = from(centre, 1, ring); cell[1] <= to(centre, 1, ring); ++cell[1]) {
        const bool face = std::max(std::abs(cell[2] - centre[2]), std::abs(cell[1] - centre[1])) == ring;
        for (cell[0] = centre[0] - ring; cell[0] <= centre[0] + ring;
             cell[0] += face ? 2 * ring + 1 : 2 * ring)
          visitRow(cell, face ? centre[0] + ring : cell[0], visit);
      }
  }
  /// Whether all sites lie within that many rings of the cell of x.
  bool endsWithin(const Eigen::Vector3d& x, std::int64_t ring) const;

 private:
  using Cell = std::array<std::int64_t, 3>;

  Cell cellOf(const Eigen::Vector3d& x) const {
    return {cellCoordinate(x[0], cellSize_), cellCoordinate(x[1], cellSize_),
            cellCoordinate(x[2], cellSize_)};
  }
  std::int64_t from(const Cell& centre, int axis, std::int64_t ring) const {
    return std::max(centre[axis] - ring, low_[axis]);
  }
  std::int64_t to(const Cell& centre, int axis, std::int64_t ring) const {
    return std::min(centre[axis] + ring, high_[axis]);
  }
  /// The sites of the cells from `first` to the one at `last` along x.
  template <typename Visit>
  void visitRow(const Cell& first, std::int64_t last, const Visit& visit) const {
    const std::int64_t begin = std::max(first[0], low_[0]), end = std::min(last, high_[0]);
    if (begin > end) return;
    if (start_.empty()) {
      for (std::int64_t x = begin; x <= end; ++x) visit(hashed({x, first[1], first[2]}));
    } else {
      const std::size_t place = placeOf({begin, first[1], first[2]});
      visit(Run{start_[place], start_[place + static_cast<std::size_t>(end - begin) + 1]});
    }
  }
  std::uint64_t keyOf(const Cell& cell) const;
  Run hashed(const Cell& cell) const;
  double width(int axis) const {
    return static_cast<double>(high_[axis]) - static_cast<double>(low_[axis]) + 1;
  }
  std::size_t placeOf(const Cell& cell) const {
    const std::int64_t row = (cell[2] - low_[2]) * (high_[1] - low_[1] + 1) + cell[1] - low_[1];
    return static_cast<std::size_t>(row * (high_[0] - low_[0] + 1) + cell[0] - low_[0]);
  }
  bool fitsTable() const;
  void fillTable();

  double cellSize_, maxRadius_ = 0;
  Eigen::Vector3d lowest_, highest_;
  Cell low_, high_;  ///< of the cells that are not empty
  /// First site of each cell in the box low_ .. high_, then their number; empty if the box is too large.
  std::vector<std::int32_t> start_;
  CellHash cells_;  ///< instead of it
  std::vector<Site> sites_;
  std::vector<std::int32_t> runStart_;
};

/// The sites around one cell of the grid, nearest rings first, gathered as far as they are asked for: what is
/// near one bubble of the cell is near all. One per thread.
class Vicinity {
 public:
  std::vector<double> x, y, z, radius;  ///< [m], padded
  std::vector<std::int32_t> site;       ///< number in the grid

  /// Starts anew around the cell of `centre` [m]; the grid must outlive the use.
  void moveTo(const SiteGrid& grid, const Eigen::Vector3d& centre);
  const SiteGrid& grid() const { return *grid_; }
  /// One past the last site of the ring.
  std::size_t endOf(std::int64_t ring) {
    while (static_cast<std::int64_t>(ringEnd_.size()) <= ring) gatherRing();
    return ringEnd_[ring];
  }

 private:
  void gatherRing();
  void add(const SiteGrid::Run& run);

  const SiteGrid* grid_ = nullptr;
  Eigen::Vector3d centre_;
  std::vector<std::size_t> ringEnd_;
};

}  // namespace spume::foam
