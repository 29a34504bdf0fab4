#pragma once

#include <cstdint>
#include <vector>

#include "fluid/dense_field.h"
#include "fluid/marker_particles.h"

namespace spume::fluid {

/// Finds the markers that are on the wrong side of the surface for good: positive ones that sank, negative
/// ones that were thrown out.
class LostMarkers {
 public:
  /// Calls body(n), in the order of the set, for every marker on the wrong side by more than `depth` and by
  /// more than its own radius [cells]. Sets the escaped flags of all.
  template <typename Body>
  void forEach(const MarkerScene& scene, const DenseField<float>& phi, MarkerSign sign, double depth,
               MarkerSet& markers, const Body& body) {
    find(scene, phi, sign, depth, markers);
    for (const std::vector<std::int32_t>& chunk : lost_)
      for (const std::int32_t n : chunk) body(n);
  }

 private:
  void find(const MarkerScene& scene, const DenseField<float>& phi, MarkerSign sign, double depth,
            MarkerSet& markers);

  std::vector<std::vector<std::int32_t>> lost_;  ///< of each chunk of markers
};

}  // namespace spume::fluid
