#pragma once

#include "fluid/dense_field.h"
#include "fluid/grid_spec.h"
#include "fluid/layer_list.h"
#include "fluid/solid_boundary.h"

namespace spume::fluid {

/// Makes phi a signed distance again within kLevelSetBand cells without moving the surface; beyond, +-band
/// with the sign kept. Cells next to the surface get phi/|grad phi|, then layers grow outwards by the
/// second-order upwind eikonal equation [Sethian 1999; Jeong, Whitaker 2008]. Cells inside solids neither
/// start nor carry distances. The result does not depend on the number of threads.
class Reinitializer {
 public:
  explicit Reinitializer(const GridSpec& grid);

  /// Ghosts of phi and its values behind walls (SolidExtension::apply) must be set; ghosts are refilled,
  /// values behind walls are left for SolidExtension::apply. `solids` may be null.
  void apply(DenseField<float>& phi, const SolidBoundary* solids = nullptr);

 private:
  void markInterface(const DenseField<float>& phi, const SolidBoundary* solids);
  void fixInterface(const DenseField<float>& phi);
  void growLayer(int layer);
  void restoreSigns(DenseField<float>& phi) const;

  GridSpec grid_;
  LayerList layers_;
  DenseField<float> distance_;  ///< |phi| [cells], kFar where not known yet
  std::vector<float> update_;
};

}  // namespace spume::fluid
