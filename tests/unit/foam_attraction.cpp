// Capillary attraction of floating bubbles, and what holds bubbles to solids.
#include <gtest/gtest.h>

#include <cmath>

#include "foam/attraction.h"
#include "foam/forces/solid_adhesion.h"
#include "foam/forces/solid_attraction.h"
#include "foam/forces/weak_attraction.h"
#include "tests/foam_fixtures.h"

namespace spume::foam::test {
namespace {

TEST(WeakAttraction, BesselFunctionIsTheLibrarys) {
  constexpr double kSeries = 3e-7;  // relative error of the printed polynomials, 2.2e-7 at worst
  for (double x = 0.01; x < 6; x *= 1.07) {
    const double exact = std::cyl_bessel_k(1.0, x);
    EXPECT_NEAR(besselK1(x), exact, kSeries * exact) << x;
  }
}

TEST(WeakAttraction, FollowsTheCapillaryLaw) {
  // accuracy, W1: f_i f_j K1(d / L_c) / (2 pi sigma L_c) at d / L_c = 0.5, 1, 2, 4; and the contact force of
  // r = 1 mm.
  constexpr double kAim = 1e-6;
  FoamParams params = waterParams(Preset::physical);
  params.attractionLaw = AttractionLaw::capillary;
  const double length = capillaryLength(params), r = 1e-3, gas = ballVolume(r);
  EXPECT_NEAR(length, 2.727e-3, 1e-6);
  const double load = params.density * 9.81 * gas;
  for (const double x : {0.5, 1.0, 2.0, 4.0}) {
    const double exact =
        load * load * std::cyl_bessel_k(1.0, x) / (2 * std::numbers::pi * params.surfaceTension * length);
    EXPECT_NEAR(weakAttraction(params, gas, r, gas, r, x * length), exact, kAim * exact);
  }
  EXPECT_NEAR(weakAttraction(params, gas, r, gas, r, 2 * r), 1.3e-6, 0.05e-6);
}

TEST(WeakAttraction, IsSymmetricAndEndsAtItsRange) {
  for (const AttractionLaw law : {AttractionLaw::coefficient, AttractionLaw::capillary}) {
    FoamParams params = makePreset(Preset::paper);
    params.attractionLaw = law;
    const double small = ballVolume(0.5e-3), large = ballVolume(2e-3),
                 range = kAttractionRange * capillaryLength(params);
    EXPECT_EQ(weakAttraction(params, small, 0.5e-3, large, 2e-3, 5e-3),
              weakAttraction(params, large, 2e-3, small, 0.5e-3, 5e-3));
    EXPECT_GT(weakAttraction(params, small, 0.5e-3, large, 2e-3, 0.99 * range), 0);
    EXPECT_EQ(weakAttraction(params, small, 0.5e-3, large, 2e-3, 1.01 * range), 0);
  }
}

TEST(WeakAttraction, PaperLawShrinksWithSmallBubbles) {
  FoamParams params = makePreset(Preset::paper);
  params.attractionLaw = AttractionLaw::coefficient;
  EXPECT_DOUBLE_EQ(weakAttraction(params, 1e-9, 2e-3, 1e-9, 2e-3, 8e-3), 4e-6 * 2 / 8);
  EXPECT_DOUBLE_EQ(weakAttraction(params, 1e-9, 0.5e-3, 1e-9, 0.5e-3, 8e-3), 4e-6 * 0.125 * 0.5 / 8);
}

TEST(WeakAttraction, DrawsTwoFloatingBubblesTogether) {
  FoamParams params = makePreset(Preset::physical);
  params.attractionLaw = AttractionLaw::capillary;
  params.bursting = false;
  BubbleStore bubbles;
  for (const double x : {-2.5e-3, 2.5e-3})
    bubbles.add(bubbleAt({x, 0, 0}, 1e-3, {0, 0, 0}, BubbleClass::surface));
  FoamSolver solver(params);
  const StillPool pool = openPool(params);
  double before = 1;
  for (int step = 0; step < 300; ++step) {
    solver.step(bubbles, pool, 0.005);
    const double d = (bubbles.position[0] - bubbles.position[1]).norm();
    if (d > 2e-3) {
      ASSERT_LT(d, before + 1e-12) << step;
    }
    before = d;
    ASSERT_NEAR(bubbles.position[0].x(), -bubbles.position[1].x(), 1e-12);  // action = reaction
  }
  EXPECT_LT(before, 2e-3);  // they have met
}

TEST(WeakAttraction, PullsOnManyFloatingBubblesAddUpToNothing) {
  constexpr double kRound = 1e-15;  // accuracy, W1: of the sum of all pulls
  FoamParams params = makePreset(Preset::physical);
  const StillPool pool = openPool(params);
  BubbleStore bubbles;
  for (std::uint64_t i = 0; i < 300; ++i) {
    CounterRandom random(23, i, 1);
    const double x = random.uniform(), z = random.uniform(), r = 0.3e-3 + 0.9e-3 * random.uniform();
    bubbles.add(bubbleAt({0.06 * x, 0, 0.06 * z}, r, {0, 0, 0}, BubbleClass::surface));
    bubbles.surfaceWeight.back() = 0.2 + 0.8 * random.uniform();
  }
  Surroundings around;
  around.sample(pool, bubbles.positions());
  FoamTopology topology;
  PowerCells().compute(bubbles.position, bubbles.radius, bubbles.id, topology);
  for (const AttractionLaw law : {AttractionLaw::coefficient, AttractionLaw::capillary}) {
    params.attractionLaw = law;
    Vectors3 force;
    Attraction().compute(params, bubbles, around, pool, topology, force);
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double pulls = 0;
    for (const Eigen::Vector3d& f : force) sum += f, pulls += f.norm();
    EXPECT_GT(pulls, 0);
    EXPECT_LE(sum.norm(), kRound * pulls);
  }
}

TEST(SolidAttraction, WettingAttractsAndNonWettingRepels) {
  FoamParams params = makePreset(Preset::physical);
  params.attractionLaw = AttractionLaw::capillary;
  const double length = capillaryLength(params), gas = ballVolume(1e-3),
               load = surfaceLoad(params, gas, 1e-3);
  SolidSurface solid;
  for (const double degrees : {30.0, 60.0, 120.0}) {
    solid.contactAngle = degrees;
    const double expected = load / std::tan(degrees * std::numbers::pi / 180) * std::exp(-2);
    EXPECT_NEAR(solidAttraction(params, solid, gas, 1e-3, 2 * length), expected, 1e-6 * std::abs(expected));
  }
  solid.contactAngle = 0;
  EXPECT_TRUE(std::isfinite(solidAttraction(params, solid, gas, 1e-3, 0)));
}

TEST(SolidAttraction, PaperLawIsBoundedAtTheWall) {
  FoamParams params = makePreset(Preset::paper);
  params.attractionLaw = AttractionLaw::coefficient;
  EXPECT_DOUBLE_EQ(solidAttraction(params, {}, 1e-9, 2e-3, 0), 2e-7 / 2e-3);
  EXPECT_DOUBLE_EQ(solidAttraction(params, {}, 1e-9, 2e-3, 5e-3), 2e-7 / 5e-3);
}

/// Pull on a lone bubble of 1 mm afloat at (x, 0, z) in a corner with walls at x = 0 and z = 0 [N].
Eigen::Vector3d pullInCorner(const FoamParams& params, double x, double z) {
  StillPoolParams pool;
  pool.lower = {0, -1, 0}, pool.closed = {true, false, false, false, true, false};
  const StillPool corner(pool);
  BubbleStore bubbles;
  bubbles.add(bubbleAt({x, 0, z}, 1e-3, {0, 0, 0}, BubbleClass::surface));
  bubbles.surfaceWeight[0] = 1;
  Surroundings around;
  around.sample(corner, bubbles.positions());
  Vectors3 force;
  Attraction().compute(params, bubbles, around, corner, {}, force);
  return force[0];
}

TEST(SolidAttraction, IsTheLawAtAFlatWallAndLastsWhileABubbleTouches) {
  constexpr double kRoundOff = 1e-12, kFar = 0.5;
  for (const AttractionLaw law : {AttractionLaw::coefficient, AttractionLaw::capillary}) {
    FoamParams params = makePreset(Preset::paper);
    params.attractionLaw = law;
    for (const double psi : {0.999e-3, 1.001e-3, 3e-3}) {
      const Eigen::Vector3d pull = pullInCorner(params, psi, kFar);
      const double exact = solidAttraction(params, params.walls, ballVolume(1e-3), 1e-3, psi);
      EXPECT_NEAR(pull.x(), -exact, kRoundOff * exact);
      EXPECT_LE(std::abs(pull.z()), kRoundOff * exact);
    }
  }
}

/// The nearest wall changes on the diagonal; the pull's direction must not jump there.
TEST(SolidAttraction, TurnsSmoothlyFromWallToWall) {
  FoamParams params = makePreset(Preset::physical);
  params.attractionLaw = AttractionLaw::capillary;
  const double step = 1e-5;                   // [m], a hundredth of the radius
  const double turn = 0.5 * step / 1e-3 * 2;  // the slope goes from wall to wall over the bubble's width
  Eigen::Vector3d last = pullInCorner(params, 3e-3, 1.5e-3);
  for (double z = 1.5e-3; z < 4.5e-3; z += step) {
    const Eigen::Vector3d pull = pullInCorner(params, 3e-3, z);
    EXPECT_LE((pull - last).norm(), 2 * turn * std::max(pull.norm(), last.norm())) << z;
    last = pull;
  }
  const Eigen::Vector3d diagonal = pullInCorner(params, 3e-3, 3e-3);
  EXPECT_NEAR(diagonal.x(), diagonal.z(), 1e-12 * diagonal.norm());
}

/// A sticky vertical wall x = 0 with liquid on its positive side, and a bubble that touches it.
BubbleStore onStickyWall(double radius, double detachRadius, int steps) {
  FoamParams params = makePreset(Preset::physical);
  params.attractionLaw = AttractionLaw::capillary;
  params.bursting = false;
  params.walls.detachRadius = detachRadius;
  StillPoolParams pool;
  pool.surfaceHeight = 1, pool.lower = {0, -1, -1}, pool.closed = {true, false, false, false, false, false};
  BubbleStore bubbles;
  bubbles.add(bubbleAt({0.9 * radius, 0, 0}, radius));
  FoamSolver solver(params);
  for (int step = 0; step < steps; ++step) solver.step(bubbles, StillPool(pool), 0.005);
  return bubbles;
}

TEST(SolidAdhesion, HoldsABubbleUntilItsBuoyancyExceedsThePinning) {
  const BubbleStore held = onStickyWall(0.9e-3, 1e-3, 400);
  EXPECT_EQ(held.touchedSolid[0], 1);
  EXPECT_LE(std::abs(held.position[0].y()), 1e-6);           // 2 s: it gives way by less than a micrometre
  EXPECT_LE(std::abs(held.position[0].x()), 0.01 * 0.9e-3);  // its centre has come to the wall
  const BubbleStore loose = onStickyWall(1.1e-3, 1e-3, 400);
  EXPECT_EQ(loose.touchedSolid[0], 0);
  EXPECT_GT(loose.position[0].y(), 0.2);
}

TEST(SolidAdhesion, AHeldBubbleIsHalfABallThatHoldsItsGas) {
  const BubbleStore held = onStickyWall(0.9e-3, 1.5e-3, 600);
  EXPECT_NEAR(held.volume[0] / held.gas[0], 1, 1e-3);
  EXPECT_NEAR(held.radius[0], 0.9e-3 * std::cbrt(2.0), 0.01e-3);
}

TEST(SolidAdhesion, CleanGlassHoldsNothing) {
  EXPECT_FALSE(adheres(FoamParams(), SolidSurface(), 1e-12, 1e-4, 1, 0));
}

}  // namespace
}  // namespace spume::foam::test
