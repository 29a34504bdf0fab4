#include "fluid/pressure_system.h"

#include <functional>
#include <numeric>

#include "fluid/pressure_rows.h"

namespace spume::fluid {
namespace {

/// Diagonal of each cell of a row. On its own so that nothing it reads can alias what it writes.
[[gnu::noinline]] void sumRow(const float* __restrict wx, const float* __restrict wy,
                              const float* __restrict wz, const float* __restrict excess, std::ptrdiff_t si,
                              std::ptrdiff_t sj, int count, float* __restrict diagonal) {
  for (int k = 0; k < count; ++k)
    diagonal[k] = wx[k] + wx[k + si] + wy[k] + wy[k + sj] + wz[k] + wz[k + 1] + excess[k];
}

/// Turns the diagonals of a row into their inverses; returns the range of its unknowns.
ActiveRow invertRow(int i, int j, float* diagonal, int count) {
  int begin = 0, end = count;
  while (end > 0 && !(diagonal[end - 1] > 0)) --end;
  while (begin < end && !(diagonal[begin] > 0)) ++begin;
  for (int k = begin; k < end; ++k) diagonal[k] = diagonal[k] > 0 ? 1 / diagonal[k] : 0;
  return {i, j, begin, end};
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
  const int nx = cells().x(), ny = cells().y(), nz = cells().z();
  rows.resize(static_cast<std::size_t>(nx) * ny);
  forEachRow(cells(), [&](int i, int j) {
    float* diagonal = &inverseDiagonal(i, j, 0);
    sumRow(&weight[0](i, j, 0), &weight[1](i, j, 0), &weight[2](i, j, 0), &excess(i, j, 0), excess.stride(0),
           excess.stride(1), nz, diagonal);
    rows[i * ny + j] = invertRow(i, j, diagonal, nz);
  });
  std::erase_if(rows, [](const ActiveRow& row) { return row.begin >= row.end; });
  rowStart.assign(static_cast<std::size_t>(nx) * ny + 1, 0);
  for (const ActiveRow& row : rows) rowStart[row.i * ny + row.j + 1] = 1;
  std::partial_sum(rowStart.begin(), rowStart.end(), rowStart.begin());
}

double PressureMatrix::multiply(const DenseField<double>& x, DenseField<double>& y) const {
  return reduceActiveRows(
      rows, [&](const ActiveRow& row) { return multiplyRow(*this, row, x, y); }, std::plus<>());
}

}  // namespace spume::fluid
