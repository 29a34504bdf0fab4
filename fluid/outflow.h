#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "fluid/dense_field.h"
#include "fluid/grid_spec.h"
#include "fluid/marker_set.h"
#include "fluid/solid_boundary.h"
#include "fluid/volume_control.h"

namespace spume::fluid {

/// A free region of fewer cells may be filled as a pocket of noise (kLargestFilledPocket is 4); twice that
/// for the part of it that liquid fills within a sub-step.
inline constexpr int kFewestFreeCells = 8;

/// A region that takes liquid out. A free one is open to the air: liquid that comes into it is gone, and its
/// surface there has p = 0. A pump takes `rate` from the liquid in its region, as far as there is some.
struct Outflow {
  std::string name;
  std::function<double(const Eigen::Vector3d& x)> sdf;  ///< < 0 inside the region [m]
  bool free = true;
  std::function<double(double t)> rate;  ///< pump: [m^3/s]; free: open where > 0
};

/// The outflows of a scene on the grid. What they take is booked by VolumeControl.
class OutflowSet {
 public:
  /// Throws InvalidParameter if a region covers too few cells: one for a pump, eight for a free one, which
  /// the grid would close as a small pocket.
  OutflowSet(const GridSpec& grid, std::vector<Outflow> outflows);

  /// Once per sub-step, after phi and the negative markers were carried to time t: empties the free regions
  /// that are open. Returns the liquid that was in them [m^3].
  double empty(double t, const SolidBoundary& boundary, DenseField<float>& phi, MarkerSet& negative,
               VolumeControl& books) const;

  /// Before the projection of the sub-step [t - dt, t]: adds the sinks of the pumps to `divergenceSource`
  /// [1/s]. Returns what they take in dt [m^3].
  double pump(double t, double dt, const DenseField<float>& phi, const SolidBoundary& boundary,
              DenseField<float>& divergenceSource, VolumeControl& books) const;

  /// Cells of the free regions that are open at time t: air that holds one is open air, however small.
  std::vector<Eigen::Vector3i> openCells(double t) const;

 private:
  struct Cell {
    Eigen::Vector3i cell;
    float sdf;  // [m]
  };
  struct Region {
    std::vector<Cell> cells;                // where a free region raises phi
    std::vector<Eigen::Vector3i> interior;  // cells whose centre is inside
  };
  bool isOpen(std::size_t n, double t) const { return outflows_[n].rate(t) > 0; }
  void takeMarkers(const Outflow& outflow, MarkerSet& negative) const;

  GridSpec grid_;
  std::vector<Outflow> outflows_;
  std::vector<Region> regions_;
};

}  // namespace spume::fluid
