#pragma once

#include <vector>

#include "foam/film_forces.h"
#include "foam/foam_params.h"
#include "foam/surroundings.h"

namespace spume::foam {

/// Draws the borders of a dry foam to Plateau's law: films that meet in a border at other angles than 120
/// degrees pull it, and bubbles follow at the rate `border_rate`, dx/dt = rate f / (2 sigma), f of
/// FilmForces, a tenth of f / (2 sigma) at most in a step. Deviation: forces of [Busaryev 2012] act along
/// pairs; a border among three bubbles or a corner of six feels none of them. A motion beside the implicit
/// step, not a force in it: springs, stiff enough to carry a pile, and what holding volumes adds to them
/// would leave nothing of surface tension there. Films count by how dry and how far out of the liquid their
/// bubbles are, (1 - lambda)(1 - chi). At rest the drift and what the springs take back of it in a step
/// cancel.
class BorderDrift {
 public:
  /// The drift of a step of dt [s] from the bubbles' present places, without effect at a rate of 0. Geometry
  /// as for FilmForces, measured there.
  void find(const FoamParams& params, const Surroundings& around, const FoamTopology& topology,
            const Neighbours& neighbours, const std::vector<NearWalls>& walls, const BubbleStore& bubbles,
            double dt);
  /// Moves the bubbles, whose number and order are those of find(). Velocities stay: the drift has no
  /// inertia.
  void advance(BubbleStore& bubbles) const;

 private:
  Eigen::Vector3d move(std::size_t i, double share, const std::vector<NearWalls>& walls,
                       const BubbleStore& bubbles) const;

  std::vector<double> tension_, wetness_;  ///< in units of 2 sigma, and lambda
  std::vector<char> fixed_;
  FilmForces films_;
  Vectors3 move_;  ///< [m]; empty without drift
};

}  // namespace spume::foam
