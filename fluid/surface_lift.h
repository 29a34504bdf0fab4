#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "fluid/crowding.h"
#include "fluid/dense_field.h"
#include "fluid/grid_spec.h"
#include "fluid/marker_set.h"
#include "fluid/sampling.h"
#include "fluid/solid_boundary.h"

namespace spume::fluid {

/// Makes room for crowded liquid: lifts the surface nearest to it, phi and the markers along with it, by as
/// much as the volume asks for. That gives the liquid no speed. (The same volume as a source of divergence
/// where it is crowded, at the pressure of the impact, gave the jet of a dam break three times the energy
/// that had been lost.)
class SurfaceLift {
 public:
  explicit SurfaceLift(const GridSpec& grid) : grid_(grid), spotAt_(grid.cells, -1) {}

  /// phi must be a distance, with its ghosts filled; both are so again afterwards but for values in solids
  /// (SolidExtension).
  void apply(const std::vector<CrowdedCell>& crowded, const SolidBoundary& solids, DenseField<float>& phi,
             MarkerSet& positive, MarkerSet& negative);

 private:
  /// A cell in which something moves.
  struct Spot {
    Eigen::Vector3i cell;
    float lift;  ///< along the normal [dx]; at first the volume that comes up there [dx^3]
  };
  struct Links {
    int count = 0;
    std::array<std::int32_t, 26> spot;
  };

  bool isSurface(const Eigen::Vector3i& c) const;
  bool leadsAway(const Eigen::Vector3i& c, const Eigen::Vector3i& n) const;
  Eigen::Vector3i comesUpAt(const Eigen::Vector3i& cell) const;
  bool addSpot(const Eigen::Vector3i& c, float lift);
  void bringUp(const std::vector<CrowdedCell>& crowded);
  void widen();
  void spread();
  void deepen();
  void moveMarkers(MarkerSet& markers) const;

  GridSpec grid_;
  DenseField<std::int32_t> spotAt_;  ///< -1: none; only set during a call
  std::vector<Spot> spots_;          ///< those of the surface first
  std::vector<Eigen::Vector3i> places_;
  std::vector<Links> links_;
  std::vector<float> spreadTo_;

  // of the call under way
  const DenseField<float>* phi_ = nullptr;
  const SolidBoundary* solids_ = nullptr;
};

}  // namespace spume::fluid
