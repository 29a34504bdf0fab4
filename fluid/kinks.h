#pragma once

#include <cstdint>

#include "fluid/dense_field.h"

namespace spume::fluid {

/// Marks the points where phi bends too sharply for a cubic: second difference along some axis above half the
/// steepest first difference (a radius of curvature below 2 cells, or a medial surface). There a cubic
/// overshoots and thickens films; linear interpolation keeps them. Covers one ghost layer; ghosts of phi must
/// be filled.
void markKinks(const DenseField<float>& phi, DenseField<std::uint8_t>& kinks);

/// True if a corner of the cube with low corner (i, j, k) is marked.
inline bool cubeIsKinked(const DenseField<std::uint8_t>& kinks, int i, int j, int k) {
  const std::uint8_t* m = &kinks(i, j, k);
  const std::ptrdiff_t si = kinks.stride(0), sj = kinks.stride(1);
  return m[0] | m[1] | m[sj] | m[sj + 1] | m[si] | m[si + 1] | m[si + sj] | m[si + sj + 1];
}

}  // namespace spume::fluid
