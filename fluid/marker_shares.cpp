#include "fluid/marker_shares.h"

#include <algorithm>
#include <atomic>

#include "fluid/level_set.h"
#include "fluid/marker_sampling.h"
#include "fluid/parallel.h"

namespace spume::fluid {
namespace {

/// The cell of every marker whose value says that it is on its own side, else -1.
void keepAtHome(float side, int count, const float* __restrict value, const std::int32_t* __restrict cell,
                std::int32_t* __restrict home) {
  for (int n = 0; n < count; ++n) home[n] = side * value[n] > 0 ? cell[n] : -1;
}

}  // namespace

/// Finds the cells of the markers on their own side and counts them there.
void MarkerShares::findHomes(const MarkerScene& scene, const DenseField<float>& phi, MarkerSign sign,
                             const MarkerSet& markers) {
  const float side = static_cast<float>(static_cast<int>(sign));
  resizeWithRoom(home_, markers.size());
  forEachRow(scene.grid.cells, [&](int i, int j) { std::fill_n(&count_(i, j, 0), scene.grid.cells.z(), 0); });
  forEachMarkerChunk(markers.size(), [&](std::size_t first, std::size_t last) {
    MarkerValues values;
    MarkerCells cells;
    sampleAtMarkers(phi, scene.solids.sides, markers, first, last, values);
    findMarkerCells(count_, markers, first, last, cells);
    keepAtHome(side, static_cast<int>(last - first), values.data(), cells.data(), home_.data() + first);
    for (std::size_t n = first, end; n < last; n = end) {  // neighbours in memory share cells
      for (end = n + 1; end < last && home_[end] == home_[n];) ++end;
      if (home_[n] < 0) continue;
      const std::atomic_ref<std::int32_t> count(count_.data()[home_[n]]);
      count.fetch_add(static_cast<std::int32_t>(end - n), std::memory_order_relaxed);
    }
  });
}

double MarkerShares::splitCells(const MarkerScene& scene, const DenseField<float>& phi, MarkerSign sign) {
  const float dx = static_cast<float>(scene.grid.dx);
  const double cellVolume = scene.grid.cellVolume();
  const auto slab = [&](int i) {
    double total = 0;
    for (int j = 0; j < scene.grid.cells.y(); ++j)
      for (int k = 0; k < scene.grid.cells.z(); ++k) {
        const std::int32_t markers = count_(i, j, k);
        if (markers == 0) continue;
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
      if (home_[n] >= 0) markers.gas[n] = share_.data()[home_[n]];
  });
  return total;
}

}  // namespace spume::fluid
