#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fluid/dense_field.h"
#include "fluid/marker_set.h"
#include "fluid/wall_sides.h"

namespace spume::fluid {

/// Rebuilds phi from markers that crossed to the wrong side [Enright 2002, Section 3.2].
class MarkerCorrection {
 public:
  /// Each escaped marker offers its sphere to the eight cell centres around it: phi_p(x) = s (r - |x - x_p|);
  /// phi+ = max over positive markers, phi- = min over negative ones, and the one nearer to zero wins. Sets
  /// the escaped flags. Ghosts of phi must be filled and are refilled. `dx` in [m].
  /// Beside thin walls a sphere reaches the cells of its own side alone.
  /// `flagsStand`: the flags have been set since phi or the markers changed.
  void apply(float dx, const WallSides& sides, MarkerSet& positive, MarkerSet& negative,
             DenseField<float>& phi, bool flagsStand = false);

  /// Markers that offered their sphere in the last call, both signs.
  std::size_t escapedCount() const { return escapedCount_; }

 private:
  struct Offer {
    std::int32_t cell;  ///< offset in phi
    float plus, minus;  ///< best value of either sign [m]
  };
  struct Value {
    std::int32_t cell;  ///< offset in phi
    float value;        ///< of a marker's sphere there [m], > 0 inside
  };
  /// What a chunk of markers has to offer.
  struct Chunk {
    std::size_t escaped = 0;
    std::vector<Value> values;
  };
  static void addSphere(float dx, const WallSides& sides, float x, float y, float z, float radius,
                        const DenseField<float>& phi, std::vector<Value>& values);
  void listSpheres(float dx, const WallSides& sides, const DenseField<float>& phi, const MarkerSet& markers);
  void collect(MarkerSign sign, const DenseField<float>& phi);
  Offer& offerAt(std::int32_t cell, float phi);

  std::vector<Chunk> chunks_;
  std::vector<Offer> offers_;
  std::vector<std::int32_t> slot_;  ///< per point of phi: its offer, -1 for none
  std::size_t escapedCount_ = 0;
};

}  // namespace spume::fluid
