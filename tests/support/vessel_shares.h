#pragma once

#include "coupling/shapes.h"
#include "coupling/simulation.h"
#include "coupling/solid_motion.h"
#include "fluid/level_set.h"

namespace spume::coupling::test {

/// Liquid in the room of the first solid, a vessel, up to the middle of its wall and the height of its rim,
/// and elsewhere [m^3].
struct Shares {
  double in = 0, out = 0;
};

inline Shares sharesOf(const Simulation& simulation) {
  const SolidSpec& vessel = simulation.scene().solids[0];
  const Pose pose = poseAt(vessel.motion, simulation.liquid().time);
  const fluid::GridSpec& grid = simulation.liquid().grid;
  const double rim = vessel.shape.centre.y() + vessel.shape.innerHeight;
  fluid::DenseField<float> fraction(grid.cells);
  fluid::computeLiquidFraction(simulation.liquid().phi, simulation.solids(), static_cast<float>(grid.dx),
                               fraction);
  Shares shares;
  for (int i = 0; i < grid.cells.x(); ++i)
    for (int j = 0; j < grid.cells.y(); ++j)
      for (int k = 0; k < grid.cells.z(); ++k) {
        const Eigen::Vector3d x = pose.toPlaced(grid.cellCentre(i, j, k));
        const bool inside = roomInVessel(vessel.shape, x) < 0 && x.y() < rim;
        (inside ? shares.in : shares.out) += fraction(i, j, k) * grid.cellVolume();
      }
  return shares;
}

}  // namespace spume::coupling::test
