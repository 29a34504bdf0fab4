#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "foam/foam_topology.h"

namespace spume::foam {

/// Two surface bubbles i < j that attract each other through the liquid's surface: neighbours in the power
/// diagram of all bubbles that are not in contact (model, "Foam geometry").
struct WeakPair {
  std::int32_t i, j;
  double distance;  ///< d between the centres [m], at most the range
};

/// Finds weak pairs. Adding one constant a to all weights leaves the power diagram as it is, so the balls are
/// inflated to sqrt(r^2 + a) and the local engine's disc clipper asks which inflated discs survive
/// (performance, "Weak pairs"). a = (range/2)^2 is what a pair at the full range needs to meet halfway:
/// shared faces that come nowhere nearer than that to the two bubbles (far above a raft, say) do not count.
class WeakPairs {
 public:
  /// The weak pairs among bubbles with surface[i] != 0 and d <= range [m, > 0], sorted by (i, j), into `out`.
  /// All bubbles can stand between two others. `topology` is that of the same bubbles: its films are left
  /// out. Same tie-breaking by `id` as in the engines; the result does not depend on the number of threads.
  /// Throws InvalidParameter as PowerCells::compute does, or for a range that is not positive and finite.
  void find(const std::vector<Eigen::Vector3d>& position, const std::vector<double>& radius,
            const std::vector<std::uint64_t>& id, const std::vector<std::uint8_t>& surface,
            const FoamTopology& topology, double range, std::vector<WeakPair>& out);
};

}  // namespace spume::foam
