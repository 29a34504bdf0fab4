#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fluid/connected_cells.h"
#include "fluid/dense_field.h"
#include "fluid/grid_spec.h"
#include "fluid/solid_boundary.h"

namespace spume::fluid {

/// A maximal set of liquid cells (phi < 0) joined by faces that are open or belong to an inflow.
struct LiquidBody {
  std::ptrdiff_t cells = 0;
  double volume = 0;  ///< of the liquid, cells cut by the surface counted in part [m^3]
  double room = 0;    ///< free-space volume of its cells [m^3]
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();  ///< mean of its cell centres [m]
  bool touchesAir = false;                             ///< false: its pressure is known up to a constant only
};

/// The connected bodies of the liquid, numbered in the order of their first cells (i slowest, k fastest).
struct LiquidBodies {
  DenseField<std::int32_t> label;  ///< body of each cell, -1 outside the liquid
  std::vector<LiquidBody> bodies;
  double volume = 0;  ///< of all liquid, fragments without a cell centre included [m^3]

  /// Keeps its arrays between calls. Cells without any free space (inside solids) are not counted.
  void find(const GridSpec& grid, const DenseField<float>& phi, const SolidBoundary& boundary);

  /// Calls visit(body, i, j, begin, end) for all runs of cells k = begin ... end - 1 of the bodies, in the
  /// order of the cells.
  template <typename Visit>
  void forEachRun(const Visit& visit) const {
    connected_.forEachRun(label.size(), visit);
  }

  /// Liquid volume of every cell in the last call of `find` [dx^3].
  const DenseField<float>& fraction() const { return fraction_; }

 private:
  /// A stretch of a slab of cells that belongs to one body, in cells and dx^3; -1: to none.
  struct Part {
    std::int32_t body = -1;
    std::ptrdiff_t cells = 0;
    double volume = 0, room = 0;
    Eigen::Vector3d centroid = Eigen::Vector3d::Zero();  // summed
  };
  void measure(const GridSpec& grid, const DenseField<float>& phi, const SolidBoundary& boundary);
  void measureSlab(int i, const GridSpec& grid, const DenseField<float>& phi, const SolidBoundary& boundary);

  ConnectedCells connected_;
  DenseField<float> fraction_;            // liquid share of each cell
  std::vector<std::vector<Part>> parts_;  // of each slab
  std::vector<std::uint8_t> touching_;    // per body: it borders air
};

}  // namespace spume::fluid
