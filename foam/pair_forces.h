#pragma once

#include <Eigen/Core>
#include <vector>

#include "foam/bubble_store.h"
#include "foam/foam_params.h"
#include "foam/foam_topology.h"

namespace spume::foam {

/// What a pair of overlapping bubbles does to each other, at the positions of the step's start.
struct PairForce {
  Eigen::Vector3d direction;  ///< unit, from i to j
  double tension = 0;         ///< pull on each other [N]; < 0 pushes apart
  double along = 0;           ///< stiffness along `direction` [N/m], >= 0
  double across = 0;          ///< stiffness against turning [N/m], >= 0
  double damping = 0;         ///< c_lap, against any relative velocity [kg/s], >= 0
};

/// Strong spring and contact damping of overlap `pair` of `topology`. `mass` [kg] per bubble. Coincident
/// centres part in a direction drawn from (seed, ids).
PairForce pairForce(const FoamParams& params, const BubbleStore& bubbles, const FoamTopology& topology,
                    const std::vector<double>& mass, const OverlapPair& pair);

}  // namespace spume::foam
