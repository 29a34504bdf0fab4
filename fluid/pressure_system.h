#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "fluid/dense_field.h"

namespace spume::fluid {

/// The part of a row of cells along k that holds unknowns.
struct ActiveRow {
  int i, j, begin, end;
};

/// Symmetric positive (semi-)definite 7-point matrix on a window of cells:
/// (A x)_c = sum over the six neighbours n of w_cn (x_c - x_n) + excess_c x_c.
/// Kept as differences and excess instead of a diagonal, so that a body without air stays exactly singular
/// on every level of the multigrid. A cell whose diagonal is 0 is no unknown; x must be 0 there.
struct PressureMatrix {
  std::array<DenseField<float>, 3> weight;  ///< coupling of a cell to its lower neighbour along each axis [-]
  DenseField<float> excess;                 ///< coupling to a known pressure, at the surface or outside [-]
  DenseField<float> inverseDiagonal;        ///< 0 where there is no unknown
  std::vector<ActiveRow> rows;              ///< in order of (i, j)
  std::vector<int> rowStart;  ///< the first of `rows` at (i, j) or later, at i ny + j; and their number

  explicit PressureMatrix(const Eigen::Vector3i& cells);
  const Eigen::Vector3i& cells() const { return excess.size(); }

  /// Computes inverseDiagonal, rows and rowStart from weight and excess.
  void finish();

  /// y = A x on the unknowns; returns x.y.
  double multiply(const DenseField<double>& x, DenseField<double>& y) const;
};

/// Rows handled as one piece of work: enough to pay for the hand-over to a thread [rows].
inline constexpr int kRowChunk = 32;

/// Number of pieces of kRowChunk rows.
inline int chunkCount(const std::vector<ActiveRow>& rows) {
  return (static_cast<int>(rows.size()) + kRowChunk - 1) / kRowChunk;
}

}  // namespace spume::fluid
