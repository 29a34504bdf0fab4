#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "fluid/air_pockets.h"
#include "fluid/fluid_params.h"
#include "fluid/grid_spec.h"

namespace spume::fluid {

/// How much gas every closed pocket should hold, kept from sub-step to sub-step while pockets move, merge and
/// split (model, "Liquid": closed air pockets keep their gas). A pocket that forms out of open air starts
/// with what it encloses; one that opens is forgotten. Merged and split ones share the sum in proportion to
/// their volumes.
class PocketBooks {
 public:
  PocketBooks(const GridSpec& grid, const FluidParams& params)
      : grid_(grid), relaxationTime_(params.volumeControlTime), lastLabel_(grid.cells, -1) {}

  /// Continues from a checkpoint with the pockets its books belong to. Throws InvalidParameter if their
  /// numbers differ.
  void resume(const AirPockets& pockets, std::vector<double> gas);

  /// Moves the books from the pockets of the last call to `pockets`; `velocity` carried them for dt [s].
  void update(const AirPockets& pockets, const MacVelocity& velocity, double dt);

  /// Rate at which each pocket of the last update is to grow [m^3/s]: it removes the pocket's error with the
  /// relaxation time of volume control.
  std::vector<double> growth(const AirPockets& pockets, double dt) const;

  const std::vector<double>& gas() const { return gas_; }  ///< [m^3]

 private:
  using Links = std::vector<std::pair<std::int32_t, std::int32_t>>;  // (new, old)
  Links trace(const AirPockets& pockets, const MacVelocity& velocity, double dt) const;
  std::vector<double> deal(const AirPockets& pockets, const Links& links) const;
  void remember(const AirPockets& pockets);

  GridSpec grid_;
  double relaxationTime_;  // [s]
  std::vector<double> gas_;
  DenseField<std::int32_t> lastLabel_;
  bool labelled_ = false;  // lastLabel_ holds a pocket
};

}  // namespace spume::fluid
