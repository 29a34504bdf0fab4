#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "foam/bubble_store.h"
#include "foam/counter_random.h"
#include "foam/foam_params.h"
#include "foam/foam_solver.h"
#include "foam/presets.h"
#include "foam/still_pool.h"
#include "tests/support/foam_balls.h"

namespace spume::foam::test {

/// A pool so deep that nothing reaches its surface.
inline StillPool deepPool(const FoamParams& params,
                          const Eigen::Vector3d& velocity = Eigen::Vector3d::Zero()) {
  StillPoolParams pool;
  pool.gravity = params.gravity, pool.density = params.density;
  pool.surfaceHeight = 1e3, pool.velocity = velocity;
  return StillPool(pool);
}

/// A pool whose surface is at height 0, without walls.
inline StillPool openPool(const FoamParams& params) {
  StillPoolParams pool;
  pool.gravity = params.gravity, pool.density = params.density;
  return StillPool(pool);
}

/// A dry, weightless world: no liquid anywhere near.
inline StillPool emptySpace() {
  StillPoolParams pool;
  pool.gravity.setZero();
  pool.surfaceHeight = -1e3;
  return StillPool(pool);
}

inline NewBubble bubbleAt(const Eigen::Vector3d& position, double radius,
                          const Eigen::Vector3d& velocity = Eigen::Vector3d::Zero(),
                          BubbleClass type = BubbleClass::liquid) {
  return {position, velocity, radius, type};
}

/// Constants of the validation cases (accuracy, header): water at 20 C.
inline FoamParams waterParams(Preset preset) {
  FoamParams params = makePreset(preset);
  params.gravity = {0, -9.81, 0};
  params.density = 998.2, params.gasDensity = 1.204, params.viscosity = 1.002e-3,
  params.surfaceTension = 0.0728;
  params.bursting = false;
  return params;
}

/// Root mean square of the speeds [m/s].
inline double rmsSpeed(const BubbleStore& bubbles) {
  double sum = 0;
  for (const auto& v : bubbles.velocity) sum += v.squaredNorm();
  return bubbles.size() ? std::sqrt(sum / static_cast<double>(bubbles.size())) : 0;
}

}  // namespace spume::foam::test
