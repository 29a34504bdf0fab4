#pragma once

#include <cmath>
#include <string>

#include "foam/bubble_store.h"
#include "foam/counter_random.h"
#include "foam/foam_params.h"
#include "foam/foam_solver.h"
#include "foam/presets.h"
#include "foam/still_pool.h"

namespace spume::apps {

/// Constants of the validation cases: water at 20 C.
inline foam::FoamParams waterAt20(foam::Preset preset) {
  foam::FoamParams params = foam::makePreset(preset);
  params.gravity = {0, -9.81, 0};
  params.density = 998.2, params.gasDensity = 1.204, params.viscosity = 1.002e-3,
  params.surfaceTension = 0.0728;
  params.bursting = false;
  return params;
}

/// A pool so deep that nothing reaches its surface.
inline foam::StillPool deepPool(const foam::FoamParams& params) {
  foam::StillPoolParams pool;
  pool.gravity = params.gravity, pool.density = params.density, pool.surfaceHeight = 1e3;
  return foam::StillPool(pool);
}

/// A pool without walls or bottom whose surface is at the height 0.
inline foam::StillPool openPool(const foam::FoamParams& params) {
  foam::StillPoolParams pool;
  pool.gravity = params.gravity, pool.density = params.density;
  return foam::StillPool(pool);
}

/// A dry, weightless world: no liquid anywhere near.
inline foam::StillPool emptySpace() {
  foam::StillPoolParams pool;
  pool.gravity.setZero(), pool.surfaceHeight = -1e3;
  return foam::StillPool(pool);
}

/// Three numbers in [0, 1).
inline Eigen::Vector3d randomVector(foam::CounterRandom& random) {
  const double x = random.uniform(), y = random.uniform(), z = random.uniform();
  return {x, y, z};
}

/// "5 ms"
inline std::string stepName(double dt) { return std::to_string(std::lround(1e3 * dt)) + " ms"; }

/// Root mean square of the speeds [m/s].
inline double rmsSpeed(const foam::BubbleStore& bubbles) {
  double sum = 0;
  for (const auto& v : bubbles.velocity) sum += v.squaredNorm();
  return std::sqrt(sum / static_cast<double>(bubbles.size()));
}

}  // namespace spume::apps
