#pragma once

#include <Eigen/Core>
#include <vector>

#include "fluid/dense_field.h"
#include "fluid/grid_spec.h"
#include "fluid/solid_boundary.h"

namespace spume::fluid {

/// Liquid of a cell that phi does not show there.
struct CrowdedCell {
  Eigen::Vector3i cell;
  float volume;  ///< [dx^3]; negative: phi shows too much
};

/// Finds the liquid that transport has lost. Up to its surface the velocity has no divergence; what carries
/// the surface beyond has: where a stream comes upon a wall or other liquid the velocity of the gap between
/// them ends in front of it, and phi, which is only carried along, crowds the liquid that enters into what
/// room there is. A parcel that has gone along x(t) is denser by exp(-int div u(x(t), t) dt) than it was.
/// Without this a ball that falls on a floor loses an eighth of itself at a CFL number of 4.
class Crowding {
 public:
  explicit Crowding(const GridSpec& grid);

  /// Before phi moves: keeps the divergence of `velocity`, which is going to carry it, in the cells of air.
  /// What sources and pockets give the liquid is meant to be there, and left out.
  void prepare(const DenseField<float>& phi, const SolidBoundary& solids, const MacVelocity& velocity);

  /// When `velocity` has carried phi for dt [s]: lists the cells with liquid that is not shown. Ghosts of
  /// both must be filled.
  void find(const DenseField<float>& phi, const SolidBoundary& solids, const MacVelocity& velocity,
            double dt);
  /// What the last call found, in the order of the cells.
  const std::vector<CrowdedCell>& cells() const { return crowded_; }
  /// Of that the volume [dx^3] for which the surface nearby has no room in one go: whole bodies of liquid
  /// that ran into something within the step.
  double excess();

 private:
  float compression(const MacVelocity& velocity, float cellsPerSpeed, const Eigen::Vector3i& cell,
                    float way) const;

  float crowdedIn(const Eigen::Vector3i& c, const DenseField<float>& phi, const SolidBoundary& solids,
                  const MacVelocity& velocity, float cellsPerSpeed) const;

  GridSpec grid_;
  DenseField<float> divergence_;  ///< in air, 0 elsewhere [m/s per cell]
  std::vector<std::vector<CrowdedCell>> slabs_;
  std::vector<CrowdedCell> crowded_;
  DenseField<float> blocks_;  ///< crowded volume of each block [dx^3]; 0 between calls
};

}  // namespace spume::fluid
