#pragma once

#include <Eigen/Core>

#include "fluid/liquid_state.h"

namespace spume::coupling {

/// Two states of a liquid on one grid.
struct FramePair {
  const fluid::LiquidState& before;
  const fluid::LiquidState& after;
  double interval;  ///< from one to the other [s], > 0
};

/// Writes phi, velocity and grad p of the time `share` (0..1) of the way from one state to the other into
/// `now`, whose windows have the size of the grid. phi at a place between two frames was upstream in the
/// earlier and will be downstream in the later one: it is the mean by `share` of the two, each followed along
/// its path; the mean of the frames as they stand would show a jet's tip at two places, half of it each. The
/// velocity is that of the nearer frame as it stands, followed only where that frame has air: the mean of two
/// eddies is none, and bubbles sink as deep as eddies carry them. grad p = rho (g - Du/Dt), Du/Dt from the
/// velocities at the two ends of a path, g where the liquid leaves the air or goes there. `density` [kg/m^3],
/// `gravity` [m/s^2].
void blendFrames(const FramePair& frames, double share, double density, const Eigen::Vector3d& gravity,
                 fluid::LiquidState& now);

}  // namespace spume::coupling
