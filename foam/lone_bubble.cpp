#include "foam/lone_bubble.h"

#include "foam/forces/buoyancy.h"
#include "foam/forces/drag.h"

namespace spume::foam {
namespace {

/// Under an overhanging surface buoyancy grows along the path out of the liquid; it is then held at its first
/// value, because a force that grows with the motion has no implicit step.
double frozenImmersion(const LoneBubble& b, double phiAt, double lift) {
  return lift > 0 ? immersedFraction(phiAt, b.radius) : b.immersed;
}

}  // namespace

Eigen::Vector3d LoneBubble::surfaceForce(double phiAt) const {
  return frozenImmersion(*this, phiAt, fullBuoyancy.dot(up)) * fullBuoyancy +
         liquidAdhesion(adhesion, phiAt, radius, start) * up;
}

double LoneBubble::surfacePull(double phiAt, double lift) const {
  return frozenImmersion(*this, phiAt, lift) * lift + liquidAdhesion(adhesion, phiAt, radius, start);
}

double LoneBubble::surfaceStiffness(double phiAt, double lift) const {
  const double fromLift = lift > 0 ? lift * immersedFractionSlope(phiAt, radius) : 0;
  return fromLift + liquidAdhesionSlope(adhesion, phiAt, radius, start);
}

Eigen::Vector3d LoneBubble::force(const Eigen::Vector3d& v, double dt) const {
  const Eigen::Vector3d slip = v - liquidVelocity;
  return weight + surfaceForce(phiAfter(v, dt)) + dragForce(drag, slip) - viscousDrag * slip - airDrag * v;
}

}  // namespace spume::foam
