#include "foam/forces/liquid_adhesion.h"

#include <algorithm>

namespace spume::foam {
namespace {

/// Lowest phi at which the adhesion still changes.
double lowest(double radius, StepStart start) { return start == StepStart::afloat ? -radius : 0; }

}  // namespace

StepStart stepStart(double phi, double radius) {
  if (phi < -radius) return StepStart::immersed;
  return phi > radius ? StepStart::aloft : StepStart::afloat;
}

double liquidAdhesion(double strength, double phi, double radius, StepStart start) {
  if (start == StepStart::aloft) return 0;
  return -strength * std::clamp(phi, lowest(radius, start), radius);
}

double liquidAdhesionSlope(double strength, double phi, double radius, StepStart start) {
  const bool inside = phi > lowest(radius, start) && phi < radius;
  return start == StepStart::aloft || !inside ? 0 : -strength;
}

}  // namespace spume::foam
