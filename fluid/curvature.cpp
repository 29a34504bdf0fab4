#include "fluid/curvature.h"

#include <algorithm>
#include <cmath>

#include "fluid/parallel.h"

namespace spume::fluid {
namespace {

/// The first and second differences of phi at a cell, per cell.
struct Differences {
  double x, y, z, xx, yy, zz, xy, yz, zx;

  /// At `p`, whose neighbours along x and y lie `si` and `sj` before and after it.
  Differences(const float* p, std::ptrdiff_t si, std::ptrdiff_t sj) {
    const auto cross = [p](std::ptrdiff_t a, std::ptrdiff_t b) {
      return 0.25 * ((double(p[a + b]) - p[a - b]) - (double(p[b - a]) - p[-a - b]));
    };
    const auto second = [p](std::ptrdiff_t a) { return double(p[a]) - 2.0 * p[0] + p[-a]; };
    x = 0.5 * (double(p[si]) - p[-si]), y = 0.5 * (double(p[sj]) - p[-sj]), z = 0.5 * (double(p[1]) - p[-1]);
    xx = second(si), yy = second(sj), zz = second(1);
    xy = cross(si, sj), yz = cross(sj, 1), zx = cross(1, si);
  }
  /// div(grad phi/|grad phi|) per cell.
  double curvature() const {
    const double square = x * x + y * y + z * z;
    if (!(square > 0)) return 0;
    const double numerator = x * x * (yy + zz) + y * y * (xx + zz) + z * z * (xx + yy) -
                             2 * (x * y * xy + y * z * yz + z * x * zx);
    return numerator / (square * std::sqrt(square));
  }
};

/// The differences as the cell's own side of a thin wall has them.
Differences differencesAt(const WallSides& sides, const DenseField<float>& phi, int i, int j, int k) {
  if ((sides.guard(i, j, k) & WallSides::kBeside) == 0) return {&phi(i, j, k), phi.stride(0), phi.stride(1)};
  const WallSides::Block block = sides.read(phi, {i, j, k});
  return {&block[WallSides::kCentre], 9, 3};  // 3 cells an edge, z fastest
}

}  // namespace

void computeCurvature(const GridSpec& grid, const WallSides& sides, const DenseField<float>& phi,
                      DenseField<float>& kappa) {
  if (kappa.size() != grid.cells) kappa = DenseField<float>(grid.cells);
  const double band = kCurvatureBand * grid.dx;
  forEachCell(grid.cells, [&](int i, int j, int k) {
    const bool near = std::abs(phi(i, j, k)) < band;
    // phi is in metres and its differences per cell: their quotient is in 1/dx.
    const double perCell = near ? differencesAt(sides, phi, i, j, k).curvature() : 0;
    kappa(i, j, k) = static_cast<float>(std::clamp(perCell, -1.0, 1.0) / grid.dx);
  });
}

}  // namespace spume::fluid
