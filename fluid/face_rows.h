#pragma once

#include "fluid/dense_field.h"

namespace spume::fluid {

/// The rows of a face field that bound a row of cells: [side] across x and y, and the minus faces across z.
struct FaceRows {
  const float* x[2];
  const float* y[2];
  const float* z;
  FaceRows(const MacField<float>& field, int i, int j)
      : x{&field[0](i, j, 0), &field[0](i + 1, j, 0)},
        y{&field[1](i, j, 0), &field[1](i, j + 1, 0)},
        z(&field[2](i, j, 0)) {}
};

}  // namespace spume::fluid
