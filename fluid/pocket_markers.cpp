#include "fluid/pocket_markers.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fluid/impact_speed.h"

namespace spume::fluid {

void collapsePockets(const MarkerScene& scene, const std::vector<FilledPocket>& filled,
                     const DenseField<float>& phi, const MacVelocity& velocity, MarkerSorter& sorter,
                     DenseField<std::int32_t>& cellMark, MarkerSet& positive,
                     std::vector<CollapsedPocket>& collapsed) {
  if (filled.empty()) return;
  for (std::size_t p = 0; p < filled.size(); ++p)
    for (const Eigen::Vector3i& cell : filled[p].pocket.cells) cellMark(cell) = static_cast<std::int32_t>(p);

  const Eigen::Vector3i last = scene.grid.cells - Eigen::Vector3i::Ones();
  const auto cellOf = [](float x, int high) { return std::clamp(static_cast<int>(std::floor(x)), 0, high); };
  for (std::size_t m = 0; m < positive.size(); ++m) {
    const std::int32_t p = cellMark(cellOf(positive.x[m], last.x()), cellOf(positive.y[m], last.y()),
                                    cellOf(positive.z[m], last.z()));
    if (p < 0) continue;
    positive.x[m] = std::numeric_limits<float>::quiet_NaN();
  }
  sorter.compact(positive);

  for (std::size_t p = 0; p < filled.size(); ++p) {
    for (const Eigen::Vector3i& cell : filled[p].pocket.cells) cellMark(cell) = -1;
    const AirPocket& pocket = filled[p].pocket;
    const int cells = static_cast<int>(pocket.cells.size());
    if (cells > 1)
      collapsed.push_back({pocket.centroid, filled[p].velocity, pocket.gas, cells,
                           impactSpeed(scene, phi, velocity, pocket.centroid)});
  }
}

}  // namespace spume::fluid
