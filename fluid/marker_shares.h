#pragma once

#include <cstdint>
#include <vector>

#include "fluid/dense_field.h"
#include "fluid/marker_particles.h"

namespace spume::fluid {

/// Splits the volume of every cell among the markers of one sign in it: air among positive markers, liquid
/// among negative ones. Where a marker then goes under, or is thrown out of the liquid, its share is the
/// volume that went with it (model, "Coupling", rule 2).
class MarkerShares {
 public:
  explicit MarkerShares(const GridSpec& grid) : count_(grid.cells), share_(grid.cells) {}

  /// Sets the column `gas` [m^3] of every marker that is on its own side of the surface to the volume of that
  /// side in its cell / markers there on their own side. Returns the sum of the shares [m^3].
  double refresh(const MarkerScene& scene, const DenseField<float>& phi, MarkerSign sign, MarkerSet& markers);

 private:
  void findHomes(const MarkerScene& scene, const DenseField<float>& phi, MarkerSign sign,
                 const MarkerSet& markers);
  double splitCells(const MarkerScene& scene, const DenseField<float>& phi, MarkerSign sign);

  LargeVector<std::int32_t>
      home_;  ///< offset of each marker's cell in the fields below, -1 if not on its side
  DenseField<std::int32_t> count_;  ///< markers on their own side per cell
  DenseField<float> share_;         ///< volume per such marker [m^3]
};

}  // namespace spume::fluid
