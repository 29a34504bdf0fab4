#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace spume::foam {

/// The indices of the points along Hilbert's curve through their bounding cube, 1024 cells along an edge,
/// ties by index: what is near in space is near in the order. A function of the positions [m, finite] alone.
/// O(n log n).
void sortInSpace(const std::vector<Eigen::Vector3d>& position, std::vector<std::int32_t>& order);

}  // namespace spume::foam
