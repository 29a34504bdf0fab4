#pragma once

#include "foam/foam_params.h"

namespace spume::foam {

/// One of the two bubbles of a contact, as the response needs it.
struct SqueezedBubble {
  double radius;    ///< [m]
  double filmArea;  ///< sum over its films [m^2]
  double freeArea;  ///< [m^2]
};

/// How much stiffer a contact is whose bubbles hold their volumes: squeezed by its neighbours a bubble must
/// swell where its surface is free, and its rest lengths swell with it. A share of the spring's own stiffness
/// [-], >= 0; grows without limit as a bubble loses its free surface, so it is capped. With it in the
/// implicit step radii that follow the volumes at once do not feed back: without it piles shake.
double volumeResponse(const SqueezedBubble& i, const SqueezedBubble& j, double wetness);

}  // namespace spume::foam
