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
  /// `surfaceStands`: phi and solids are those of the last call, whose layers, if as many, serve again.
  void apply(const DenseField<float>& phi, const SolidBoundary& solids, int layers, MacVelocity& velocity,
             bool surfaceStands = false);

  /// Lets a velocity that `apply` has continued go on without divergence in the first cell of air, as far as
  /// the flow inside agrees. A surface lies between faces: carried by a velocity that is constant beyond the
  /// known faces it lags by up to half a cell's change of it, which makes waves 0.6 % too slow at 64 cells a
  /// half length. Only for what carries the surface: velocities carried by it blow up where gaps close.
  /// `surfaceStands` as above.
  void goOn(const DenseField<float>& phi, const SolidBoundary& solids, MacVelocity& velocity,
            bool surfaceStands = false);

 private:
  void markKnown(int axis, const DenseField<float>& phi, const SolidBoundary& solids);
  float outflowShare(const Eigen::Vector3i& cell, const MacVelocity& velocity) const;
  float continuation(int axis, const Eigen::Vector3i& face, const DenseField<float>& phi,
                     const SolidBoundary& solids, const MacVelocity& velocity) const;
  void spread(int axis, int layer, const DenseField<float>& phi, DenseField<float>& component) const;

  GridSpec grid_;
  std::array<LayerList, 3> layers_;
  std::array<std::vector<float>, 3> change_;  ///< to the faces of the first layer [m/s]
};

/// Gives closed faces (open = 0) the normal velocity of their solid and prescribed faces that of their
/// inflow, then refills the ghosts.
void constrainToSolids(const SolidBoundary& solids, MacVelocity& velocity);

}  // namespace spume::fluid
