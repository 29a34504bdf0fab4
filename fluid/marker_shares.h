#pragma once

#include <cstdint>
#include <vector>

#include "fluid/dense_field.h"
#include "fluid/doubtful_cells.h"
#include "fluid/marker_particles.h"

namespace spume::fluid {

/// Splits the volume of every cell among the markers of one sign in it: air among positive markers, liquid
/// among negative ones. Where a marker then goes under, or is thrown out of the liquid, its share is the
/// volume that went with it (model, "Coupling", rule 2).
class MarkerShares {
 public:
  explicit MarkerShares(const GridSpec& grid) : count_(grid.cells), share_(grid.cells), doubt_(grid.cells) {}

  /// Sets the column `gas` [m^3] of every positive marker in the air to the air of its cell / such markers
  /// there. Returns the sum of the shares [m^3].
  double refreshAir(const MarkerScene& scene, const DenseField<float>& phi, MarkerSet& positive);

  /// Sets the column `gas` [m^3] of the negative markers to the liquid of their cell / markers there,
  /// wherever phi is not in doubt. Where it is, a marker keeps what it has, for liquid keeps its volume: the
  /// grid draws a film thinner than a cell too thick here and not at all there, and who divided that anew at
  /// every step would give the markers that are left the liquid of those that escaped, too. Both columns
  /// `escaped` must be up to date. Returns the sum of the shares it set [m^3].
  double refreshLiquid(const MarkerScene& scene, const DenseField<float>& phi, const MarkerSet& positive,
                       MarkerSet& negative);

 private:
  void findHomes(const MarkerScene& scene, const DenseField<float>& phi, MarkerSign sign,
                 const MarkerSet& markers);
  double refresh(const MarkerScene& scene, const DenseField<float>& phi, MarkerSign sign, MarkerSet& markers);
  double splitCells(const MarkerScene& scene, const DenseField<float>& phi, MarkerSign sign);

  LargeVector<std::int32_t> home_;  ///< offset of each marker's cell in the fields below, -1: gets no share
  DenseField<std::int32_t> count_;  ///< markers with a share per cell
  DenseField<float> share_;         ///< volume per such marker [m^3]
  DoubtfulCells doubt_;
};

}  // namespace spume::fluid
