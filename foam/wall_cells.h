#pragma once

#include <vector>

#include "foam/bubble_store.h"
#include "foam/foam_params.h"
#include "foam/foam_topology.h"
#include "foam/near_walls.h"
#include "foam/power_cells.h"

namespace spume::foam {

/// A bubble whose centre is nearer to a solid than this many radii is cut by its plane; beyond it the cap
/// behind the plane holds 3e-4 of the ball and is not worth a plane.
inline constexpr double kCutByWall = 0.98;

/// Whether there is a bubble of `radius` [m] whose distance `psi` [m] to the nearest solid is that small.
bool isAnyCutByWall(const std::vector<double>& radius, const Eigen::VectorXd& psi);

/// The balls that stand for the planes of solids, those of a bubble one after the other.
struct WallPlanes {
  std::vector<std::int32_t> owner;        ///< row of the bubble, ascending
  std::vector<Eigen::Vector3d> position;  ///< [m]
  std::vector<double> radius;             ///< [m]
  std::vector<std::uint64_t> id;          ///< breaks ties as an id of its own
  std::vector<std::int32_t> behind;       ///< rows of the bubbles wholly behind a plane

  /// Lists those of all bubbles. `walls` as WallCells::compute takes them.
  void list(const BubbleStore& bubbles, const std::vector<NearWalls>& walls);

 private:
  void add(const BubbleStore& bubbles, const NearWalls& walls, std::size_t i);

  std::vector<std::uint8_t> isCut_;  ///< has a wall so near: few of all
};

/// Whether a bubble of `radius` [m] is cut by walls `a` as by walls `b`, to the last bit.
bool cutAlike(double radius, const NearWalls& a, const NearWalls& b);

/// Power cells of bubbles at solids, cut by the planes of the solids, exactly. A plane enters the power
/// diagram as a ball behind it: one at x - r n of squared radius 2 r (r - psi) has the plane as its radical
/// plane with the bubble, and is the farther of the two, as power goes, from every point on the free side. So
/// it takes from nobody there, and behind the plane each bubble loses all to its own. Deviation: [Busaryev
/// 2012, 5.2] doubles the volume of every wall bubble.
class WallCells {
 public:
  explicit WallCells(Connectivity engine = Connectivity::local) : engine_(engine) {}

  /// As PowerCells::compute, with volumes, free areas and films on the free side of the solids only; a bubble
  /// wholly behind a plane has volume and areas 0. `walls`: within a radius of each bubble, or empty where
  /// none is cut; that costs as much as PowerCells.
  void compute(const BubbleStore& bubbles, const std::vector<NearWalls>& walls, FoamTopology& out);
  /// The overlapping pairs of `topology`, which is that of the last call, as Neighbours::build gives them.
  void listNeighbours(const FoamTopology& topology, Neighbours& out) const;

 private:
  Connectivity engine_;
  PowerCells cells_;
  WallPlanes planes_;
  std::vector<Eigen::Vector3d> position_;  ///< of the bubbles, then of the balls behind planes [m]
  std::vector<double> radius_;
  std::vector<std::uint64_t> id_;
};

}  // namespace spume::foam
