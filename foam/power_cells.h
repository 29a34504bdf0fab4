#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "foam/foam_topology.h"
#include "foam/neighbours.h"

namespace spume::foam {

/// The local engine: power cells restricted to their balls, films and contacts, from overlapping neighbours
/// only (model, "Foam geometry"). Keeps its list of neighbours and its scratch memory from call to call; the
/// result depends on the arguments of the call alone, bit for bit, for any number of threads.
class PowerCells {
 public:
  PowerCells();
  ~PowerCells();
  PowerCells(PowerCells&&) noexcept;
  PowerCells& operator=(PowerCells&&) noexcept;

  /// Fills `out` for balls at `position` [m] with `radius` [m, > 0]. `id` breaks exact ties: each radius is
  /// scaled by 1 + 1e-9 x hash(id) while contacts are decided, and volumes and areas are corrected back to
  /// first order. The last `cutters` balls are no bubbles: they cut the others, but nothing of theirs goes
  /// out, and where they cut is no film. O(n) for bounded numbers of neighbours. Throws InvalidParameter if
  /// lengths differ, or a position or radius is not finite or a radius not positive.
  void compute(const std::vector<Eigen::Vector3d>& position, const std::vector<double>& radius,
               const std::vector<std::uint64_t>& id, FoamTopology& out, std::size_t cutters = 0);
  /// The overlapping pairs of the last call as Neighbours::build would give them, in parallel row by row.
  void listNeighbours(Neighbours& out) const;

 private:
  struct Internals;
  std::unique_ptr<Internals> internals_;
};

}  // namespace spume::foam
