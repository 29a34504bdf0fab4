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
  /// The sites once more, padded, for loops that want but these [m].
  struct Columns {
    std::vector<double> x, y, z, radius;
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
  const Columns& columns() const { return column_; }
  /// First site of each cell that is not empty, then the number of sites.
  const std::vector<std::int32_t>& runStart() const { return runStart_; }

  /// How much a site can matter by its cell: `along[axis][k]` is the part of the cells k - ring from the one
  /// in the middle along that axis; cells matter where the three parts add up to more than `least`.
  struct Worth {
    std::array<std::vector<double>, 3> along;
    double least = 0;
  };
  /// Calls visit(run) for runs of the sites whose cell is `ring` cells from that of x, in the largest
  /// coordinate; of those that do not matter at least some are left out.
  template <typename Visit>
  void visitRing(const Eigen::Vector3d& x, std::int64_t ring, const Worth& worth, const Visit& visit) const {
    const Cell middle = cellOf(x);
    const double alongX = *std::max_element(worth.along[0].begin(), worth.along[0].end());
    const double alongY = *std::max_element(worth.along[1].begin(), worth.along[1].end());
    for (std::int64_t z = from(middle, 2, ring); z <= to(middle, 2, ring); ++z) {
      const double layer = worth.least - worth.along[2][z - middle[2] + ring];
      if (!(alongX + alongY > layer)) continue;
      for (std::int64_t y = from(middle, 1, ring); y <= to(middle, 1, ring); ++y) {
        const double least = layer - worth.along[1][y - middle[1] + ring];
        if (!(alongX > least)) continue;
        const bool whole = std::max(std::abs(z - middle[2]), std::abs(y - middle[1])) == ring;
        visitRingRow({middle[0], y, z}, ring, whole, worth.along[0], least, visit);
      }
    }
  }
  /// The lower corner of the cell of x [m].
  Eigen::Vector3d cornerOf(const Eigen::Vector3d& x) const {
    const Cell cell = cellOf(x);
    return cellSize_ * Eigen::Vector3d(static_cast<double>(cell[0]), static_cast<double>(cell[1]),
                                       static_cast<double>(cell[2]));
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
  /// The sites of a ring in the row of `middle` along x, in which at least one cell matters: the whole row,
  /// or but its ends.
  template <typename Visit>
  void visitRingRow(const Cell& middle, std::int64_t ring, bool whole, const std::vector<double>& along,
                    double least, const Visit& visit) const {
    std::int64_t first = -ring, last = ring;
    const auto visitFrom = [&](std::int64_t begin, std::int64_t end) {
      visitRow({middle[0] + begin, middle[1], middle[2]}, middle[0] + end, visit);
    };
    if (!whole) {
      if (along.front() > least) visitFrom(first, first);
      if (along.back() > least) visitFrom(last, last);
      return;
    }
    while (!(along[first + ring] > least)) ++first;
    while (!(along[last + ring] > least)) --last;
    visitFrom(first, last);
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
  Columns column_;
  std::vector<std::int32_t> runStart_;
};

/// The sites around one cell of the grid, nearest rings first: the nearest are the same for all bubbles of
/// the cell, those beyond are gathered for one bubble. One per thread.
class Vicinity {
 public:
  std::vector<double> x, y, z, radius;  ///< [m], padded
  std::vector<std::int32_t> site;       ///< number in the grid, padded

  /// Starts anew around the cell of `centre` [m]; the grid must outlive the use.
  void moveTo(const SiteGrid& grid, const Eigen::Vector3d& centre);
  const SiteGrid& grid() const { return *grid_; }
  /// Leaves those in the cell and the 26 around it, and returns how many they are.
  std::size_t keepNearest();
  /// Adds those of a ring that matter, and returns how many there are in all.
  std::size_t addRing(std::int64_t ring, const SiteGrid::Worth& worth);

 private:
  void add(const SiteGrid::Run& run);
  void makeRoom(std::size_t sites);

  const SiteGrid* grid_ = nullptr;
  Eigen::Vector3d centre_;
  std::size_t count_ = 0, nearest_ = 0;  ///< sites in all; in the nearest cells, once asked for
};

}  // namespace spume::foam
