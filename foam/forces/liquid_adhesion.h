#pragma once

namespace spume::foam {

/// Where a bubble began the step: it decides which way the surface can hold it during the step.
enum class StepStart { immersed, afloat, aloft };

/// immersed phi < -r, afloat |phi| <= r, aloft phi > r.
StepStart stepStart(double phi, double radius);

/// Liquid adhesion along grad phi, -w s_lad phi [Eq. 5] [N]; `strength` = w s_lad [N/m].
/// Deviation: Eq. 5 grows without bound and ends with a jump at phi = r, which throws bubbles out; here it
/// saturates at strength r while the step lasts. A bubble that began immersed is only held back (no pull up
/// before it has arrived), one that began aloft feels nothing. So the force never grows with phi within a
/// step.
double liquidAdhesion(double strength, double phi, double radius, StepStart start);

/// d force / d phi of the same [N/m], <= 0.
double liquidAdhesionSlope(double strength, double phi, double radius, StepStart start);

}  // namespace spume::foam
