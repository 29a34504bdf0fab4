#include "fluid/marker_shares.h"

#include <atomic>

#include "fluid/level_set.h"
#include "fluid/marker_chunks.h"
#include "fluid/parallel.h"
#include "fluid/sampling.h"

namespace spume::fluid {
namespace {

Eigen::Vector3i cellOf(const MarkerSet& markers, std::size_t n, const Eigen::Vector3i& cells) {
  const Eigen::Vector3i cell =
      Eigen::Vector3f(markers.x[n], markers.y[n], markers.z[n]).array().floor().cast<int>();
  return cell.cwiseMax(0).cwiseMin(cells - Eigen::Vector3i::Ones());
}

/// Calls visit(n) for the markers on their own side of the surface, in parallel.
template <typename Visit>
void forEachAtHome(const DenseField<float>& phi, MarkerSign sign, const MarkerSet& markers,
                   const Visit& visit) {
  const FieldView field(phi);
  const float side = static_cast<float>(static_cast<int>(sign));
  forEachMarkerChunk(markers.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n)
      if (side * sampleCentred(field, markers.x[n], markers.y[n], markers.z[n]) > 0) visit(n);
  });
}

}  // namespace

void MarkerShares::countAtHome(const MarkerScene& scene, const DenseField<float>& phi, MarkerSign sign,
                               const MarkerSet& markers) {
  count_.fill(0);
  forEachAtHome(phi, sign, markers, [&](std::size_t n) {
    std::atomic_ref<std::int32_t>(count_(cellOf(markers, n, scene.grid.cells)))
        .fetch_add(1, std::memory_order_relaxed);
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
  countAtHome(scene, phi, sign, markers);
  const double total = splitCells(scene, phi, sign);
  forEachAtHome(phi, sign, markers,
                [&](std::size_t n) { markers.gas[n] = share_(cellOf(markers, n, scene.grid.cells)); });
  return total;
}

}  // namespace spume::fluid
