// Two floating bubbles drawing together against drag alone (accuracy, 4.5: W2).
#include <gtest/gtest.h>

#include "tests/foam_fixtures.h"

namespace spume::foam::test {
namespace {

/// Water in which the speed of a floating bubble is the pull on it over 6 pi mu r: Stokes' drag below the
/// surface and above it, and next to no inertia.
FoamParams creepingWater(double radius) {
  FoamParams params = waterParams(Preset::physical);
  params.attractionLaw = AttractionLaw::capillary;
  params.addedMass = 0, params.wetness = params.wetnessAloft = 0;
  params.dragLaw = DragLaw::coefficient, params.dragCoefficient = 0;
  params.airDragLaw = AirDragLaw::coefficient;
  params.airDragCoefficient = 6 * std::numbers::pi * params.viscosity * radius;
  return params;
}

/// Time [s] from 8 mm apart to contact.
double meetingTime(double radius, double dt) {
  constexpr double kApart = 8e-3;
  const FoamParams params = creepingWater(radius);
  BubbleStore bubbles;
  for (const double x : {-kApart / 2, kApart / 2})
    bubbles.add(bubbleAt({x, 0, 0}, radius, {0, 0, 0}, BubbleClass::surface));
  FoamSolver solver(params);
  const StillPool pool = openPool(params);
  double before = kApart;
  for (int step = 1; step * dt < 20; ++step) {
    solver.step(bubbles, pool, dt);
    const double now = (bubbles.position[1] - bubbles.position[0]).norm();
    if (now <= 2 * radius) return dt * (step - (2 * radius - now) / (before - now));
    before = now;
  }
  return 0;
}

TEST(WeakAttraction, BringsFloatingBubblesTogetherInTheTimeOfTheLaw) {
  constexpr double kAim = 0.01;                          // accuracy, W2
  constexpr double kSmall = 10.5382, kLarge = 0.324457;  // [s] d' = -2 F(d) / (6 pi mu r), integrated
  EXPECT_NEAR(meetingTime(0.5e-3, 0.005), kSmall, kAim * kSmall);
  EXPECT_NEAR(meetingTime(0.5e-3, 0.02), kSmall, kAim * kSmall);
  EXPECT_NEAR(meetingTime(1e-3, 0.001), kLarge, kAim * kLarge);
}

}  // namespace
}  // namespace spume::foam::test
