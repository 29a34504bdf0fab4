#include "fluid/marker_shares.h"

#include <algorithm>
#include <atomic>

#include "fluid/level_set.h"
#include "fluid/marker_sampling.h"
#include "fluid/parallel.h"

namespace spume::fluid {
namespace {

/// Air: the cell of every marker whose value says that it is on its own side, else -1.
void keepInAir(int count, const float* __restrict value, const std::int32_t* __restrict cell,
               std::int32_t* __restrict home) {
  for (int n = 0; n < count; ++n) home[n] = value[n] > 0 ? cell[n] : -1;
}

/// Liquid: the cell of every marker that has not escaped, else -1. Those that stand out by less than their
/// radius still belong to it: else their part is given to the others, and when they escape it counts twice.
void keepInLiquid(int count, const std::uint8_t* __restrict escaped, const std::int32_t* __restrict cell,
                  std::int32_t* __restrict home) {
  for (int n = 0; n < count; ++n) home[n] = escaped[n] ? -1 : cell[n];
}

}  // namespace

/// Finds the cells of the markers that get a share and counts them there.
void MarkerShares::findHomes(const MarkerScene& scene, const DenseField<float>& phi, MarkerSign sign,
                             const MarkerSet& markers) {
  resizeWithRoom(home_, markers.size());
  forEachRow(scene.grid.cells, [&](int i, int j) { std::fill_n(&count_(i, j, 0), scene.grid.cells.z(), 0); });
  forEachMarkerChunk(markers.size(), [&](std::size_t first, std::size_t last) {
    const int count = static_cast<int>(last - first);
    MarkerCells cells;
    findMarkerCells(count_, markers, first, last, cells);
    if (sign == MarkerSign::positive) {
      MarkerValues values;
      sampleAtMarkers(phi, scene.solids.sides, markers, first, last, values);
      keepInAir(count, values.data(), cells.data(), home_.data() + first);
    } else {
      keepInLiquid(count, markers.escaped.data() + first, cells.data(), home_.data() + first);
    }
    for (std::size_t n = first, end; n < last; n = end) {  // neighbours in memory share cells
      for (end = n + 1; end < last && home_[end] == home_[n];) ++end;
      if (home_[n] < 0) continue;
      const std::atomic_ref<std::int32_t> inCell(count_.data()[home_[n]]);
      inCell.fetch_add(static_cast<std::int32_t>(end - n), std::memory_order_relaxed);
    }
  });
}

/// Volume per marker of every cell that has any; -1 where phi is in doubt.
double MarkerShares::splitCells(const MarkerScene& scene, const DenseField<float>& phi, MarkerSign sign) {
  const float dx = static_cast<float>(scene.grid.dx);
  const double cellVolume = scene.grid.cellVolume();
  const auto slab = [&](int i) {
    double total = 0;
    for (int j = 0; j < scene.grid.cells.y(); ++j)
      for (int k = 0; k < scene.grid.cells.z(); ++k) {
        const std::int32_t markers = count_(i, j, k);
        if (markers == 0) continue;
        share_(i, j, k) = -1;
        if (doubt_(i, j, k)) continue;
        const double liquid = liquidFractionOfCell(phi, dx, i, j, k);
        const double part = sign == MarkerSign::positive ? 1 - liquid : liquid;
        const double volume = scene.solids.cellFraction(i, j, k) * part * cellVolume;
        share_(i, j, k) = static_cast<float>(volume / markers);
        total += volume;
      }
    return total;
  };
  return reduceSlabs(scene.grid.cells.x(), 0.0, slab, [](double a, double b) { return a + b; });
}

double MarkerShares::refresh(const MarkerScene& scene, const DenseField<float>& phi, MarkerSign sign,
                             MarkerSet& markers) {
  findHomes(scene, phi, sign, markers);
  const double total = splitCells(scene, phi, sign);
  static_assert(sizeof(share_.data()[0]) == sizeof(count_.data()[0]), "both fields have the same strides");
  forEachMarkerChunk(markers.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n)
      if (home_[n] >= 0 && share_.data()[home_[n]] >= 0) markers.gas[n] = share_.data()[home_[n]];
  });
  return total;
}

double MarkerShares::refreshAir(const MarkerScene& scene, const DenseField<float>& phi, MarkerSet& positive) {
  doubt_.clear();
  return refresh(scene, phi, MarkerSign::positive, positive);
}

double MarkerShares::refreshLiquid(const MarkerScene& scene, const DenseField<float>& phi,
                                   const MarkerSet& positive, MarkerSet& negative) {
  doubt_.clear();
  doubt_.add(positive);
  doubt_.add(negative);
  return refresh(scene, phi, MarkerSign::negative, negative);
}

}  // namespace spume::fluid
