#pragma once

#include <algorithm>
#include <vector>

#include "foam/classification.h"
#include "foam/integrator.h"
#include "foam/near_walls.h"
#include "foam/presets.h"
#include "foam/space_order.h"
#include "foam/still_pool.h"
#include "tests/support/foam_relaxed.h"

namespace spume::foam::test {

/// A cube of relaxed foam that floats in a box open at the top, at the depth Archimedes gives it; nothing
/// bursts.
struct FloatingFoam {
  FoamParams params = makePreset(Preset::physical);
  BubbleStore bubbles;
  StillPoolParams box;

  FloatingFoam(int count, double wetness, std::uint64_t seed = 1) {
    constexpr double kLeastShare = 0.3;  // of its ball a bubble's gas fills, for those the foam has swallowed
    constexpr double kMargin = 0.5e-3;   // [m] the median radius: half the bubbles at a wall stand off it
    const Balls balls = relaxedFoam(count, wetness, seed);
    const FoamTopology cells = powerCellsOf(balls);
    Eigen::Vector3d low = balls.position.front(), high = low;
    for (std::size_t i = 0; i < balls.size(); ++i) {
      bubbles.add({.position = balls.position[i], .radius = balls.radius[i]});
      bubbles.radius.back() = balls.radius[i];
      bubbles.gas.back() = std::max(cells.volume[i], kLeastShare * ballVolume(balls.radius[i]));
      low = low.cwiseMin(balls.position[i]), high = high.cwiseMax(balls.position[i]);
    }
    params.wetness = params.wetnessAloft = wetness;
    params.bursting = false;
    box.gravity = params.gravity, box.density = params.density;
    box.lower = low - Eigen::Vector3d::Constant(kMargin),
    box.upper = high + Eigen::Vector3d::Constant(kMargin);
    box.surfaceHeight = low.y() + 0.36 * wetness * wetness * (high - low).y();
    box.closed = {true, true, true, false, true, true};
  }
};

/// The bubbles in space order, as a step has them.
inline BubbleStore inSpaceOrder(const BubbleStore& bubbles) {
  std::vector<std::int32_t> order;
  sortInSpace(bubbles.position, order);
  BubbleStore sorted;
  sorted.gather(bubbles, order);
  return sorted;
}

/// The part of a step that solves, from bubbles and their geometry; leaves the system in the integrator.
inline SolveReport coupleOnce(Integrator& integrator, const StillPool& pool, double dt,
                              const FoamTopology& topology, BubbleStore& bubbles) {
  Surroundings around;
  around.sample(pool, bubbles.positions());
  Neighbours neighbours;
  neighbours.build(bubbles.size(), topology.overlaps);
  weighSurface(around, topology, neighbours, bubbles);
  integrator.predict(around, Vectors3(bubbles.size(), Eigen::Vector3d::Zero()), dt, bubbles);
  std::vector<NearWalls> walls;
  findNearWalls(pool, around, bubbles, integrator.reach(), walls);
  return integrator.couple(bubbles, topology, neighbours, walls, dt);
}

}  // namespace spume::foam::test
