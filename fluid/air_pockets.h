#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "fluid/connected_cells.h"
#include "fluid/dense_field.h"
#include "fluid/grid_spec.h"
#include "fluid/solid_boundary.h"

namespace spume::fluid {

/// Pockets of at most this many cells are filled with liquid: the grid cannot keep them (model, Section 4
/// rule 5).
inline constexpr int kLargestFilledPocket = 4;

/// Air cells (phi >= 0) that hang together, or are parted by films thinner than a cell, and do not reach an
/// open domain boundary.
struct AirPocket {
  std::vector<Eigen::Vector3i> cells;                  ///< in their order
  double gas = 0;                                      ///< its air volume, cut liquid cells included [m^3]
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();  ///< mean of its cell centres [m]
};

/// A pocket that was filled.
struct FilledPocket {
  AirPocket pocket;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< mean of its faces [m/s]
};

/// The closed air pockets of the grid. In a domain without any open boundary the largest one is its
/// headspace, which counts as open air.
class AirPockets {
 public:
  /// Labels and measures them. Air that holds one of the cells `vents` is open, too.
  void find(const GridSpec& grid, const DenseField<float>& phi, const SolidBoundary& boundary,
            std::span<const Eigen::Vector3i> vents = {});

  /// Fills the small ones that the last `find` saw in the same phi, which becomes negative there. Returns all
  /// of them in the order of their first cells; those of one cell are marker noise and give no bubble.
  std::vector<FilledPocket> fillSmall(const GridSpec& grid, const SolidBoundary& boundary,
                                      const MacVelocity& velocity, DenseField<float>& phi);

  /// Counts small ones as open air, without filling them.
  void dropSmall();

  /// Pocket of each cell, -1 in liquid, solid and open air.
  const DenseField<std::int32_t>& label() const { return label_; }
  const std::vector<AirPocket>& pockets() const { return pockets_; }

 private:
  using Links = std::vector<std::pair<std::int32_t, std::int32_t>>;

  void joinAcrossFilms(const GridSpec& grid, const DenseField<float>& phi, const SolidBoundary& boundary,
                       int components);
  void linkAirBeside(const SolidBoundary& boundary, const Eigen::Vector3i& c, Links& links) const;
  void findOutside(const GridSpec& grid, const SolidBoundary& boundary,
                   std::span<const Eigen::Vector3i> vents);
  void collect(const GridSpec& grid);
  void measure(const GridSpec& grid, const DenseField<float>& phi, const SolidBoundary& boundary,
               AirPocket& pocket) const;

  ConnectedCells connected_;
  DenseField<std::int32_t> label_;
  std::vector<AirPocket> pockets_;
  std::vector<std::int32_t> joined_;   // first component of those that count as one with each component
  std::vector<Links> links_;           // components that meet at a film, slab by slab
  std::vector<std::uint8_t> outside_;  // per first component: reaches an open boundary, or is headspace
  std::vector<std::ptrdiff_t> count_;  // cells of each first component and those joined to it
};

}  // namespace spume::fluid
