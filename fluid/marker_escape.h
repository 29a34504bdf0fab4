#pragma once

#include <vector>

#include "fluid/dense_field.h"
#include "fluid/liquid_solver.h"
#include "fluid/lost_markers.h"
#include "fluid/marker_particles.h"
#include "fluid/marker_shares.h"

namespace spume::fluid {

/// What positive markers remember for entrainment: how much air each stands for, and when
/// it is lost under the surface (model, "Coupling", rules 1 and 2).
class MarkerEscape {
 public:
  explicit MarkerEscape(const GridSpec& grid) : shares_(grid), sorter_(grid) {}

  /// Rule 2: while phi > 0 at a positive marker, gas = air volume of its cell / positive markers with phi > 0
  /// in that cell [m^3]; frozen while the marker is under the surface. Returns the sum of the shares given
  /// out.
  double refreshGas(const MarkerScene& scene, const DenseField<float>& phi, MarkerSet& positive);

  /// Rule 1: positive markers with phi < -r and phi < -escapeDepth dx leave the set; they are appended to
  /// `escaped` in the order of the set, with the impact speed at their place (rule 3).
  void releaseEscaped(const MarkerScene& scene, const DenseField<float>& phi, const MacVelocity& velocity,
                      MarkerSet& positive, std::vector<EscapedMarker>& escaped);

 private:
  MarkerShares shares_;
  MarkerSorter sorter_;
  LostMarkers lost_;
};

}  // namespace spume::fluid
