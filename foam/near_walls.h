#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "foam/bubble_store.h"
#include "foam/liquid_sampler.h"
#include "foam/surroundings.h"

namespace spume::foam {

/// One flat piece of solid near a bubble.
struct NearWall {
  double psi = 0;  ///< signed distance of the bubble's centre [m], > 0 in free space
  Eigen::Vector3d away = Eigen::Vector3d::Zero();      ///< gradient of psi [-]
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< of the solid [m/s]
  int solid = -1;                                      ///< index of the solid, -1 for a wall of the domain

  double psiAfter(const Eigen::Vector3d& v, double dt) const { return psi + dt * away.dot(v - velocity); }
};

/// The walls a bubble may press on at once: more than one in an edge, a corner or a gap.
struct NearWalls {
  std::array<NearWall, 3> wall;
  int count = 0;
};

/// The search below, for one reach after another: what it finds first is kept.
class WallSearch {
 public:
  /// As findNearWalls.
  void find(const LiquidSampler& liquid, const Surroundings& around, const BubbleStore& bubbles,
            const std::vector<double>& reach, std::vector<NearWalls>& walls);
  /// Again, for another reach or other radii; `around` and the places are those of the last call of either,
  /// and `walls` what it has found: the nearest walls are not looked at anew.
  void findAgain(const LiquidSampler& liquid, const Surroundings& around, const BubbleStore& bubbles,
                 const std::vector<double>& reach, std::vector<NearWalls>& walls);

 private:
  void findFurther(const LiquidSampler& liquid, const Surroundings& around, const BubbleStore& bubbles,
                   const std::vector<double>& reach, std::vector<NearWalls>& walls);

  std::vector<std::size_t> close_;  ///< those that may know more than the nearest wall
};

/// Finds the walls within `reach` [m] of each bubble's centre; the nearest one counts always. The signed
/// distance knows the nearest only, and a bubble in a corner would be thrown from one wall to the other; so
/// those near a wall look again from one radius further inside, where the next wall is the nearest, and from
/// as far inside as they may move: a bubble just above a floor would not see the wall that the next step
/// carries it through. Walls are taken flat in between.
void findNearWalls(const LiquidSampler& liquid, const Surroundings& around, const BubbleStore& bubbles,
                   const std::vector<double>& reach, std::vector<NearWalls>& walls);

}  // namespace spume::foam
