#pragma once

#include <cstdint>
#include <vector>

#include "fluid/dense_field.h"
#include "fluid/doubtful_cells.h"
#include "fluid/fluid_params.h"
#include "fluid/grid_spec.h"
#include "fluid/marker_set.h"
#include "fluid/solid_boundary.h"

namespace spume::fluid {

/// What every marker operation reads. References only: build one per call.
struct MarkerScene {
  const GridSpec& grid;
  const FluidParams& params;
  const DomainWalls& walls;
  const SolidBoundary& solids;
  const std::vector<SolidObject>* objects = nullptr;  ///< the solids as they move in this sub-step, if any
  double middle = 0;                                  ///< time in the middle of the sub-step [s]
};

/// Moves markers by dt [s] with the midpoint rule through the staggered velocity (ghosts filled), keeps them
/// on the free side of walls along grad psi, and marks those that left an open face of the domain or sit deep
/// in a solid for removal (their x becomes NaN): follow with MarkerSorter::compact.
void advectMarkers(const MarkerScene& scene, const MacVelocity& velocity, double dt, MarkerSet& markers);

/// Orders markers by cell and drops those marked for removal. Holds scratch columns.
class MarkerSorter {
 public:
  explicit MarkerSorter(const GridSpec& grid) : cells_(grid.cells) {}
  /// Drops removed markers; the last ones take their places.
  void compact(MarkerSet& markers);
  /// Drops removed markers and sorts the others by cell (x slowest, z fastest), stable inside a cell.
  void sort(MarkerSet& markers);
  /// After `sort`: drops what has been removed since, and puts new markers in their places. `added[i]` holds
  /// those of slab i (cells of one x), sorted by cell; in a cell they come last. As fast as copying.
  void insert(const std::vector<MarkerSet>& added, MarkerSet& markers);
  /// After `sort`, until markers are added or removed: first marker of a cell; cell numbers as `cellNumber`,
  /// one past the last is the total.
  const LargeVector<std::int32_t>& cellStart() const { return cellStart_; }
  /// Number of the cell that holds a position in cell units, clamped to the grid.
  std::int32_t cellNumber(float x, float y, float z) const;

 private:
  void countInSlabs(const MarkerSet& markers);
  std::vector<std::int32_t> placeSlabs();
  void sortSlab(int slab, std::int32_t begin, std::int32_t end);
  void permute(MarkerSet& markers);
  /// Markers that stay together: of the sorted set, or of those added to the slab.
  struct Run {
    bool isNew;
    std::int32_t begin, end;
  };
  void findRuns(int slab, const MarkerSet& markers, const MarkerSet& added);

  Eigen::Vector3i cells_;
  LargeVector<std::int32_t> cellStart_, cellOf_, order_, next_;
  LargeVector<std::int32_t> bySlab_;  // numbers of the markers, slab after slab of cells
  std::vector<std::int32_t> place_;   // [chunk][slab]: markers, then place of the next one in bySlab_
  std::vector<std::vector<std::size_t>> gone_;  // of each chunk
  std::vector<std::vector<Run>> runs_;          // of each slab of cells
  LargeVector<float> column_;
  LargeVector<std::uint8_t> flags_;
};

/// Sets the radius to |phi| within [markerRadiusMin, markerRadiusMax]; an escaped marker gets the smallest
/// [Enright 2002, Eq. 11]. Refreshes the escaped flags.
void adjustRadii(const MarkerScene& scene, const DenseField<float>& phi, MarkerSign sign, MarkerSet& markers);

/// Brings the number of markers in every cell of the band to markersPerCell times the part of the cell on
/// their side [Enright 2002, Section 3.3]: deletes what strayed from the band or is too many, adds what is
/// missing at random positions keyed by (seed, cell, subStep). Escaped markers are neither counted nor
/// touched, and no marker is added to a cell where phi is in doubt: drawn from it, it would defend its error
/// (in the single vortex of 64 cells that costs four times the area that is lost without).
/// Negative markers that go for being too many leave their volume to the others of their cell.
class MarkerSeeder {
 public:
  explicit MarkerSeeder(const GridSpec& grid) : sorter_(grid), doubt_(grid.cells) {}

  /// Sorts and reseeds both sets. Called on empty sets it seeds them.
  void reseed(const MarkerScene& scene, const DenseField<float>& phi, std::int64_t subStep,
              MarkerSet& positive, MarkerSet& negative);

 private:
  struct Side;
  static void handOver(float volume, std::int32_t begin, std::int32_t end, MarkerSet& markers);
  void removeSurplus(const Side& side, MarkerSet& markers);
  void addMissing(const Side& side, std::int64_t subStep, MarkerSet& markers);

  MarkerSorter sorter_;
  DoubtfulCells doubt_;
  std::vector<std::int32_t> missing_;  ///< per cell
  std::vector<MarkerSet> slabs_;       ///< new markers of each slab of cells
};

}  // namespace spume::fluid
