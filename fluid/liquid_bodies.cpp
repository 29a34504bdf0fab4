#include "fluid/liquid_bodies.h"

#include <algorithm>
#include <atomic>

#include "fluid/level_set.h"
#include "fluid/parallel.h"

namespace spume::fluid {
namespace {

/// Body of a cell whose centre is in air but which the surface cuts: that of its deepest liquid neighbour on
/// its side of thin walls, or -1.
std::int32_t neighbourBody(const DenseField<float>& phi, const DenseField<std::int32_t>& label,
                           const WallSides& sides, int i, int j, int k) {
  std::int32_t body = -1;
  float deepest = 0;
  for (int a = 0; a < 3; ++a)
    for (int side : {-1, 1}) {
      const Eigen::Vector3i n = Eigen::Vector3i(i, j, k) + side * Eigen::Vector3i::Unit(a);
      if (label(n) < 0 || phi(n) >= deepest || !sides.sees({i, j, k}, n)) continue;
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

/// Sums of the stretches of a row that belong to one body, taken slab by slab in parallel and joined in their
/// order.
void LiquidBodies::measure(const GridSpec& grid, const DenseField<float>& phi,
                           const SolidBoundary& boundary) {
  if (fraction_.size() != grid.cells) fraction_ = DenseField<float>(grid.cells);
  computeLiquidFraction(phi, boundary, static_cast<float>(grid.dx), fraction_);
  touching_.assign(bodies.size(), 0);
  parts_.resize(grid.cells.x());
  tbb::parallel_for(0, grid.cells.x(), [&](int i) { measureSlab(i, grid, phi, boundary); });
  volume = 0;
  for (const std::vector<Part>& slab : parts_)
    for (const Part& part : slab) {
      volume += part.volume;
      if (part.body < 0) continue;
      LiquidBody& body = bodies[part.body];
      body.cells += part.cells;
      body.room += part.room;
      body.centroid += part.centroid;
      body.volume += part.volume;
    }
  volume *= grid.cellVolume();
  for (std::size_t n = 0; n < bodies.size(); ++n) {
    LiquidBody& body = bodies[n];
    body.touchesAir = touching_[n] != 0;
    body.volume *= grid.cellVolume();
    body.room *= grid.cellVolume();
    body.centroid /= static_cast<double>(body.cells);
  }
}

void LiquidBodies::measureSlab(int i, const GridSpec& grid, const DenseField<float>& phi,
                               const SolidBoundary& boundary) {
  std::vector<Part>& parts = parts_[i];
  parts.clear();
  const auto partOf = [&](std::int32_t body) -> Part& {
    if (parts.empty() || parts.back().body != body)
      parts.push_back(Part{body, 0, 0, 0, Eigen::Vector3d::Zero()});
    return parts.back();
  };
  const auto noteAir = [&](std::int32_t body, const Eigen::Vector3i& c) {
    const std::atomic_ref<std::uint8_t> touches(touching_[body]);  // only ever set: any order gives the same
    if (!touches.load(std::memory_order_relaxed) && bordersAir(label, boundary, c))
      touches.store(1, std::memory_order_relaxed);
  };
  for (int j = 0; j < grid.cells.y(); ++j)
    for (int k = 0; k < grid.cells.z(); ++k) {
      const std::int32_t body = label(i, j, k);
      const float wet = fraction_(i, j, k);
      if (body >= 0) {
        Part& part = partOf(body);
        ++part.cells;
        part.room += boundary.cellFraction(i, j, k);
        part.centroid += grid.cellCentre(i, j, k);
        part.volume += wet;
        noteAir(body, {i, j, k});
      } else if (wet > 0) {
        partOf(neighbourBody(phi, label, boundary.sides, i, j, k)).volume += wet;
      }
    }
}

}  // namespace spume::fluid
