#include "fluid/pressure_system.h"

#include <functional>

#include "fluid/pressure_rows.h"

namespace spume::fluid {
namespace {

/// 1/diagonal of each cell of a row; returns the range of its unknowns.
ActiveRow invertRow(PressureMatrix& m, int i, int j) {
  ActiveRow row{i, j, 0, 0};
  for (int k = 0; k < m.cells().z(); ++k) {
    const float diagonal = m.weight[0](i, j, k) + m.weight[0](i + 1, j, k) + m.weight[1](i, j, k) +
                           m.weight[1](i, j + 1, k) + m.weight[2](i, j, k) + m.weight[2](i, j, k + 1) +
                           m.excess(i, j, k);
    m.inverseDiagonal(i, j, k) = diagonal > 0 ? 1 / diagonal : 0;
    if (diagonal > 0) {
      if (row.end == 0) row.begin = k;
      row.end = k + 1;
    }
  }
  return row;
}

double multiplyRow(const PressureMatrix& m, const ActiveRow& row, const DenseField<double>& in,
                   DenseField<double>& out) {
  const auto si = m.excess.stride(0), sj = m.excess.stride(1);
  const auto xi = in.stride(0), xj = in.stride(1);  // rows of double are padded differently
  const float* __restrict wx = &m.weight[0](row.i, row.j, 0);
  const float* __restrict wy = &m.weight[1](row.i, row.j, 0);
  const float* __restrict wz = &m.weight[2](row.i, row.j, 0);
  const float* __restrict excess = &m.excess(row.i, row.j, 0);
  const double* __restrict x = &in(row.i, row.j, 0);
  double* __restrict y = &out(row.i, row.j, 0);
  for (int k = row.begin; k < row.end; ++k) {
    const double c = x[k];
    y[k] = wx[k] * (c - x[k - xi]) + wx[k + si] * (c - x[k + xi]) + wy[k] * (c - x[k - xj]) +
           wy[k + sj] * (c - x[k + xj]) + wz[k] * (c - x[k - 1]) + wz[k + 1] * (c - x[k + 1]) + excess[k] * c;
  }
  return dotProduct(x + row.begin, y + row.begin, row.end - row.begin);
}

}  // namespace

PressureMatrix::PressureMatrix(const Eigen::Vector3i& cells)
    : weight{DenseField<float>(cells), DenseField<float>(cells), DenseField<float>(cells)},
      excess(cells),
      inverseDiagonal(cells) {}

void PressureMatrix::finish() {
  const int nx = cells().x(), ny = cells().y();
  rows.resize(static_cast<std::size_t>(nx) * ny);
  forEachRow(cells(), [&](int i, int j) { rows[i * ny + j] = invertRow(*this, i, j); });
  std::erase_if(rows, [](const ActiveRow& row) { return row.end == 0; });
}

double PressureMatrix::multiply(const DenseField<double>& x, DenseField<double>& y) const {
  return reduceActiveRows(
      rows, [&](const ActiveRow& row) { return multiplyRow(*this, row, x, y); }, std::plus<>());
}

}  // namespace spume::fluid
