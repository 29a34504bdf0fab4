#include "fluid/doubtful_cells.h"

#include <cmath>

#include "fluid/marker_sampling.h"

namespace spume::fluid {

void DoubtfulCells::add(const MarkerSet& markers) {
  const Eigen::Vector3i last = doubt_.size() - Eigen::Vector3i::Ones();
  forEachEscaped(markers, 0, markers.size(), [&](std::size_t n) {
    if (std::isnan(markers.x[n])) return;  // marked for removal
    const Eigen::Vector3i at(static_cast<int>(markers.x[n]), static_cast<int>(markers.y[n]),
                             static_cast<int>(markers.z[n]));
    const Eigen::Vector3i low = (at - Eigen::Vector3i::Ones()).cwiseMax(0);
    const Eigen::Vector3i high = (at + Eigen::Vector3i::Ones()).cwiseMin(last);
    for (int i = low.x(); i <= high.x(); ++i)
      for (int j = low.y(); j <= high.y(); ++j)
        for (int k = low.z(); k <= high.z(); ++k) doubt_(i, j, k) = 1;
  });
}

}  // namespace spume::fluid
