#pragma once

#include <string>
#include <vector>

#include "apps/reproduce/scene_run.h"

namespace spume::apps {

/// How the floating bubbles of a frame lie.
struct SurfaceCensus {
  std::size_t floating = 0;  ///< bubbles of the class surface
  double clustered = 0;      ///< share of them in contact with at least one other bubble [-]
  double atWalls = 0;        ///< share of them whose centre is within kNearWall radii of a solid [-]
  double clinging = 0;       ///< share of the submerged bubbles that are so near to a solid [-]
};

/// Radii from a wall within which a bubble counts as one of its lining: what touches it, and the half radius
/// by which adhesion lets a bubble move before it lets go (model, Eq. 7: until psi > 1.5 r).
inline constexpr double kNearWall = 1.5;

/// `toSolids` [m]: distance of every bubble to solids.
SurfaceCensus surfaceCensus(const foam::BubbleStore& bubbles, const Eigen::VectorXd& toSolids);

/// Cells that a vertical line through (x, z) passes, those of bubbles without contact left out.
/// O(bubbles + height/step x bubbles along the line).
int layersAlong(const foam::BubbleStore& bubbles, const foam::FoamTopology& topology, double x, double z);

/// Bubbles whose centre lies deeper in a solid than this share of their radius are inside it. The centre of
/// an adhering bubble rests on the surface, and rocks about it where the liquid has left it in the air.
inline constexpr double kInside = 0.5;
std::size_t insideSolids(const foam::BubbleStore& bubbles, const Eigen::VectorXd& toSolids);
/// How deep the deepest centre lies in a solid, in radii; 0 if none does.
double deepestInSolids(const foam::BubbleStore& bubbles, const Eigen::VectorXd& toSolids);

/// What events.csv says about the bubbles of a run.
struct BubbleBooks {
  std::size_t born = 0, ended = 0, left = 0;
  std::vector<double> surfaceLives;  ///< time out of the water of each bubble that burst by age [s]
};
BubbleBooks readBooks(const std::string& eventsPath);

/// Median; NaN of nothing.
double medianOf(std::vector<double> values);

}  // namespace spume::apps
