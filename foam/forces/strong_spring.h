#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "foam/foam_params.h"

namespace spume::foam {

/// lambda of a bubble at height phi [m] above the surface by the law of the parameters. height: `wetness`
/// below it, drying linearly to `wetnessAloft` at `wetnessHeight` and staying so above; perBubble: `own`, the
/// value it has, or `wetness` where that is < 0.
double wetnessAt(const FoamParams& params, double phi, double own);

/// Rest length [m] of a contact, l^2 = r_i^2 + r_j^2 + (3 lambda - 1) r_i r_j [Eq. 1]; `wetness` = lambda of
/// the pair.
inline double restLength(double ri, double rj, double wetness) {
  return std::sqrt(ri * ri + rj * rj + (3 * wetness - 1) * ri * rj);
}

/// Area [m^2] of the disc in which two balls at distance d [m] meet; 0 if they do not.
inline double filmDiscArea(double ri, double rj, double distance) {
  if (distance <= 0) return 0;
  const double height = (distance * distance + ri * ri - rj * rj) / (2 * distance);
  return std::max(0.0, std::numbers::pi * (ri * ri - height * height));
}

/// k of a pair [N/m]: max(k, f rho g r_i r_j), k a constant or 2 pi sigma s. The floor keeps large bubbles
/// from sinking through each other under their own buoyancy.
struct SpringLaw {
  double constant;  ///< k [N/m]
  double floor;     ///< f rho g [N/m^3]

  explicit SpringLaw(const FoamParams& params);
  double operator()(double ri, double rj) const { return std::max(constant, floor * ri * rj); }
};

/// The same for one pair.
double springStiffness(const FoamParams& params, double ri, double rj);

/// A pair force along the line of centres and its stiffness.
struct PairSpring {
  double tension = 0;  ///< pull of the pair on each other [N]; < 0 pushes apart
  double along = 0;    ///< d tension / d distance [N/m], >= 0
  double across =
      0;  ///< stiffness against turning [N/m], tension / distance where that is >= 0, else dropped
};

/// Strong interaction at distance d [Eq. 2].
/// Deviation: the printed spring switches off the moment a film ends, and a raft then jitters for ever. Here
/// a compressed pair (d < l) always pushes, film or not; a stretched one pulls with the share min(1, A / (0.1
/// A_rest)) of its film.
inline PairSpring strongSpring(double stiffness, double ri, double rj, double wetness, double distance,
                               double filmArea) {
  constexpr double kFullFilmShare = 0.1;  // of the rest film (model, "strong spring")
  const double rest = restLength(ri, rj, wetness), restArea = filmDiscArea(ri, rj, rest);
  const double share = restArea > 0 ? std::min(1.0, filmArea / (kFullFilmShare * restArea)) : 0;
  // The geometric stiffness of a compressed spring is negative and left out [Choi and Ko 2002].
  const bool compressed = distance < rest;
  const double along = compressed ? stiffness : stiffness * share;
  return {along * (distance - rest), along, compressed ? 0 : along * (1 - rest / distance)};
}

}  // namespace spume::foam
