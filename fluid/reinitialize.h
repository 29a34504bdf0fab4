#pragma once

#include <cstdint>
#include <vector>

#include "fluid/dense_field.h"
#include "fluid/grid_spec.h"
#include "fluid/layer_list.h"
#include "fluid/solid_boundary.h"
#include "fluid/surface_seed.h"

namespace spume::fluid {

/// Makes phi a signed distance again within kLevelSetBand cells without moving the surface; beyond, +-band
/// with the sign kept. Every cell beside the surface finds its closest point on the cubic interpolant of phi
/// [Saye 2014]; these points then spread outwards layer by layer, each with its normal and curvature, and a
/// cell takes the distance to the curved patch around the nearest of them. Cells inside solids neither start
/// nor carry distances. The result does not depend on the number of threads.
class Reinitializer {
 public:
  explicit Reinitializer(const GridSpec& grid);

  /// Ghosts of phi and its values behind walls (SolidExtension::apply) must be set; ghosts are refilled,
  /// values behind walls are left for SolidExtension::apply. `solids` may be null.
  void apply(DenseField<float>& phi, const SolidBoundary* solids = nullptr);

 private:
  void markBesideWalls(const DenseField<float>& phi);
  void markInterface(const DenseField<float>& phi, const SolidBoundary* solids);
  void plantSeeds(const DenseField<float>& phi);
  void spreadLayer(int layer, bool outwardsOnly);
  void measure(DenseField<float>& phi) const;

  GridSpec grid_;
  const SolidBoundary* solids_ = nullptr;  ///< of the call under way
  LayerList layers_;
  DenseField<std::uint8_t> kinks_;
  std::vector<SurfaceSeed> seeds_;  ///< of the cells of layer 0, in their order
  std::vector<float> seedX_, seedY_,
      seedZ_;                        ///< where they lie, apart: what the search for the nearest one reads
  DenseField<std::int32_t> seedOf_;  ///< nearest seed known to a cell, -1 for none
  std::vector<std::int32_t> update_;
};

}  // namespace spume::fluid
