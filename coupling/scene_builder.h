#pragma once

#include <Eigen/Core>
#include <functional>

#include "coupling/errors.h"
#include "coupling/scene.h"
#include "coupling/vdb_liquid_sampler.h"
#include "fluid/liquid_solver.h"

namespace spume::coupling {

using SignedDistance = std::function<double(const Eigen::Vector3d&)>;

/// The grid of a scene: cubic cells, `resolution` of them along the longest edge; the other edges are rounded
/// to whole cells (at least 4), the low corner stays.
fluid::GridSpec gridOf(const Scene& scene);

/// Everything LiquidSolver is built from: grid, walls, solids, inflows. Throws SceneError if an object of the
/// scene cannot be simulated (see `checkObjects`).
fluid::LiquidSetup buildLiquidSetup(const Scene& scene);

/// Signed distance [m] to the union of the liquid bodies, < 0 inside; a positive constant if there are none.
SignedDistance initialPhi(const Scene& scene);

/// The vessel a liquid body fills; null if it names none.
const SolidSpec* vesselOf(const Scene& scene, const LiquidBodySpec& body);

/// Signed distances [m] to each solid object at time t [s], > 0 in free space.
std::vector<SignedDistance> solidDistances(const Scene& scene, double t = 0);

/// Signed distance [m] to the nearest solid object at time t [s] (domain walls not counted), > 0 in free
/// space.
SignedDistance solidDistance(const Scene& scene, double t = 0);

/// Velocity of the solids at time t for the foam; empty if none moves.
SolidVelocity solidVelocity(const Scene& scene, double t);

/// Throws SceneError naming the first object that cannot be simulated and the remedy: a degenerate shape, a
/// name used twice, a body or an inflow outside the domain, an inflow inside a solid or without a cell to
/// itself, and what checkFoamObjects refuses.
void checkObjects(const Scene& scene);

}  // namespace spume::coupling
