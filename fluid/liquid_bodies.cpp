#include "fluid/liquid_bodies.h"

#include <algorithm>

#include "fluid/level_set.h"

namespace spume::fluid {
namespace {

/// Body of a cell whose centre is in air but which the surface cuts: that of its deepest liquid neighbour, or
/// -1.
std::int32_t neighbourBody(const DenseField<float>& phi, const DenseField<std::int32_t>& label, int i, int j,
                           int k) {
  std::int32_t body = -1;
  float deepest = 0;
  for (int a = 0; a < 3; ++a)
    for (int side : {-1, 1}) {
      const Eigen::Vector3i n = Eigen::Vector3i(i, j, k) + side * Eigen::Vector3i::Unit(a);
      if (label(n) < 0 || phi(n) >= deepest) continue;
      deepest = phi(n);
      body = label(n);
    }
  return body;
}

bool bordersAir(const DenseField<std::int32_t>& label, const SolidBoundary& boundary,
                const Eigen::Vector3i& c) {
  for (int a = 0; a < 3; ++a) {
    const Eigen::Vector3i step = Eigen::Vector3i::Unit(a);
    if (boundary.open[a](c) > 0 && label(c - step) < 0) return true;
    if (boundary.open[a](c + step) > 0 && label(c + step) < 0) return true;
  }
  return false;
}

}  // namespace

void LiquidBodies::find(const GridSpec& grid, const DenseField<float>& phi, const SolidBoundary& boundary) {
  const int count = connected_.label(
      grid.cells, [&](int i, int j, int k) { return phi(i, j, k) < 0 && boundary.cellFraction(i, j, k) > 0; },
      [&](int axis, int i, int j, int k) {
        return boundary.open[axis](i, j, k) > 0 || boundary.prescribed[axis](i, j, k) != 0;
      },
      label);
  bodies.assign(count, LiquidBody{});
  measure(grid, phi, boundary);
}

/// Sums in the order of the cells; the fractions alone are worth computing in parallel.
void LiquidBodies::measure(const GridSpec& grid, const DenseField<float>& phi,
                           const SolidBoundary& boundary) {
  if (fraction_.size() != grid.cells) fraction_ = DenseField<float>(grid.cells);
  computeLiquidFraction(phi, boundary, static_cast<float>(grid.dx), fraction_);
  volume = 0;
  for (int i = 0; i < grid.cells.x(); ++i)
    for (int j = 0; j < grid.cells.y(); ++j)
      for (int k = 0; k < grid.cells.z(); ++k) {
        std::int32_t n = label(i, j, k);
        if (n >= 0) {
          LiquidBody& body = bodies[n];
          ++body.cells;
          body.room += boundary.cellFraction(i, j, k);
          body.centroid += grid.cellCentre(i, j, k);
          body.touchesAir = body.touchesAir || bordersAir(label, boundary, {i, j, k});
        } else if (fraction_(i, j, k) > 0) {
          n = neighbourBody(phi, label, i, j, k);
        }
        volume += fraction_(i, j, k);
        if (n >= 0) bodies[n].volume += fraction_(i, j, k);
      }
  volume *= grid.cellVolume();
  for (LiquidBody& body : bodies) {
    body.volume *= grid.cellVolume();
    body.room *= grid.cellVolume();
    body.centroid /= static_cast<double>(body.cells);
  }
}

}  // namespace spume::fluid
