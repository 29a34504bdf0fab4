#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <utility>
#include <vector>

#include "foam/foam_topology.h"

namespace spume::foam {

/// The global engine, kept as the reference for PowerCells: CGAL's regular triangulation of all balls with
/// exact predicates and its alpha complex at alpha = 0 (model, "Foam geometry"). Same contract, ties decided
/// by the same jitter; about 20 times slower, sequential, keeps nothing from call to call.
class PowerDiagram {
 public:
  /// As PowerCells::compute. O(n log n) in practice. Throws InvalidParameter for the same reasons.
  void compute(const std::vector<Eigen::Vector3d>& position, const std::vector<double>& radius,
               const std::vector<std::uint64_t>& id, FoamTopology& out);
};

/// All pairs i < j, sorted, whose face in the power diagram comes within power distance `alpha` [m^2] of
/// both: the edges of the alpha complex. With an infinite alpha all edges of the regular triangulation. Same
/// jitter and same errors as above.
std::vector<std::pair<std::int32_t, std::int32_t>> alphaComplexEdges(
    const std::vector<Eigen::Vector3d>& position, const std::vector<double>& radius,
    const std::vector<std::uint64_t>& id, double alpha);

}  // namespace spume::foam
