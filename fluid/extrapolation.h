#pragma once

#include <array>
#include <vector>

#include "fluid/dense_field.h"
#include "fluid/grid_spec.h"
#include "fluid/layer_list.h"
#include "fluid/solid_boundary.h"

namespace spume::fluid {

/// Continues the liquid's velocity into air and solids, constant along the surface normal.
class VelocityExtrapolator {
 public:
  explicit VelocityExtrapolator(const GridSpec& grid);

  /// Known faces are those that touch a liquid cell (phi < 0, fluid fraction > 0) and are not closed by a
  /// solid, and those an inflow sets. From them values spread over `layers` layers of faces, then ghosts are
  /// filled; faces out of reach get 0. Closed faces are filled too, so that the tangential part reaches into
  /// walls: follow with constrainToSolids.
  void apply(const DenseField<float>& phi, const SolidBoundary& solids, int layers, MacVelocity& velocity);

 private:
  void markKnown(int axis, const DenseField<float>& phi, const SolidBoundary& solids);
  void spread(int axis, int layer, const DenseField<float>& phi, DenseField<float>& component) const;

  GridSpec grid_;
  std::array<LayerList, 3> layers_;
};

/// Gives closed faces (open = 0) the normal velocity of their solid and prescribed faces that of their
/// inflow, then refills the ghosts.
void constrainToSolids(const SolidBoundary& solids, MacVelocity& velocity);

}  // namespace spume::fluid
