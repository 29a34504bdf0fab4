// Every force term: closed values, and its slope against finite differences.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <functional>

#include "foam/forces/air_drag.h"
#include "foam/forces/buoyancy.h"
#include "foam/forces/contact_damping.h"
#include "foam/forces/drag.h"
#include "foam/forces/inertia.h"
#include "foam/forces/liquid_adhesion.h"
#include "foam/forces/strong_spring.h"
#include "foam/forces/volume_response.h"
#include "foam/forces/wall_contact.h"
#include "tests/foam_fixtures.h"

namespace spume::foam::test {
namespace {

/// Central difference; its error is h^2 f''' / 6 + eps f / h.
double slopeOf(const std::function<double(double)>& f, double x, double h) {
  return (f(x + h) - f(x - h)) / (2 * h);
}

constexpr double kDifference =
    1e-6;  // relative: h = 1e-5 of the scale gives 1e-10 + 1e-11, times slopes of order 10^3

TEST(Buoyancy, ImmersedFractionIsTheSphericalCap) {
  EXPECT_EQ(immersedFraction(-2, 1), 1);
  EXPECT_EQ(immersedFraction(2, 1), 0);
  EXPECT_DOUBLE_EQ(immersedFraction(0, 0.3), 0.5);
  // Cap of height h below the plane: pi h^2 (3 r - h) / 3 over the ball.
  for (const double s : {-0.9, -0.4, 0.2, 0.7}) {
    const double height = 1 - s;
    EXPECT_NEAR(immersedFraction(2e-3 * s, 2e-3), height * height * (3 - height) / 4, 1e-15);
  }
}

TEST(Buoyancy, SlopeIsTheDerivative) {
  for (const double phi : {-1.5e-3, -0.9e-3, -0.2e-3, 0.0, 0.6e-3, 1.2e-3})
    EXPECT_NEAR(immersedFractionSlope(phi, 1e-3),
                slopeOf([](double x) { return immersedFraction(x, 1e-3); }, phi, 1e-8), 1e-6 / 1e-3);
}

TEST(Buoyancy, PushesAgainstGravityOrDownThePressure) {
  FoamParams params = makePreset(Preset::paper);
  EXPECT_DOUBLE_EQ(fullBuoyancy(params, 2e-9, {7, 7, 7}).y(), 1000 * 9.8 * 2e-9);
  params.buoyancyLaw = BuoyancyLaw::pressureGradient;
  EXPECT_DOUBLE_EQ(fullBuoyancy(params, 2e-9, {0, -9800, 0}).y(), 9800 * 2e-9);
  EXPECT_EQ(fullBuoyancy(params, 2e-9, {0, 0, 0}).norm(), 0);  // a falling jet gives no lift
}

TEST(Inertia, AddsTheDisplacedLiquidBelowAndTheFilmsAbove) {
  const FoamParams params = makePreset(Preset::physical);
  EXPECT_DOUBLE_EQ(inertia(params, 1e-9, 0.4, 1), 1.2e-9 + 0.5e-6);
  const double liquidFraction = 0.36 * 0.16;
  EXPECT_DOUBLE_EQ(inertia(params, 1e-9, 0.4, 0), 1.2e-9 + 1e-6 * liquidFraction / (1 - liquidFraction));
  EXPECT_DOUBLE_EQ(weighedMass(params, 1e-9, 0.4, 1), 1.2e-9);
}

TEST(Drag, JacobianIsTheDerivativeAndNegativeSemidefinite) {
  const double k = 3e-4;
  for (const Eigen::Vector3d& w : {Eigen::Vector3d(0.2, -0.1, 0.05), Eigen::Vector3d(0, 0.3, 0)}) {
    const Eigen::Matrix3d jacobian = meanDragJacobian(k, w, w);
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d h = 1e-6 * Eigen::Vector3d::Unit(axis);
      const Eigen::Vector3d difference = (dragForce(k, w + h) - dragForce(k, w - h)) / 2e-6;
      EXPECT_LE((jacobian.col(axis) - difference).norm(), kDifference * jacobian.norm());
    }
    EXPECT_LE(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(jacobian).eigenvalues().maxCoeff(), 0);
  }
  EXPECT_EQ(meanDragJacobian(k, {0, 0, 0}, {0, 0, 0}).norm(), 0);
}

TEST(Drag, MeanJacobianIsTheChordAlongALine) {
  const Eigen::Vector3d from(0.1, 0, 0), to(0.4, 0, 0);
  const Eigen::Vector3d change = dragForce(2.0, to) - dragForce(2.0, from);
  EXPECT_LE((meanDragJacobian(2.0, from, to) * (to - from) - change).norm(), 1e-15);
}

TEST(Drag, SlipFollowsTheClosedForm) {
  // m w' = F - k |w| w: terminal w_t = sqrt(F/k) = 2, relaxation m / sqrt(F k) = 0.5.
  const double k = 0.25, mass = 0.25, time = 0.3;
  const Eigen::Vector3d push(0, 1, 0);
  const auto after = [&](double start) { return slipAfter({0, start, 0}, push, k, mass, time).y(); };
  EXPECT_NEAR(after(0), 2 * std::tanh(time / 0.5), 1e-14);
  EXPECT_NEAR(after(3), 2 / std::tanh(std::atanh(2.0 / 3) + time / 0.5), 1e-14);
  EXPECT_NEAR(after(-4), 2 * std::tan(std::atan(-2.0) + time / 0.5), 1e-14);
  EXPECT_NEAR(after(-0.5), 2 * std::tanh(time / 0.5 - std::atan(0.25)), 1e-14);
  EXPECT_NEAR(slipAfter({0.5, 0, 0}, {0, 0, 0}, k, mass, time).x(), 0.5 / (1 + k * 0.5 * time / mass), 1e-15);
}

TEST(Drag, SlipInTwoDirectionsIsOfFirstOrder) {
  // Against 4096 sub-steps: the error halves with dt.
  const auto error = [](int steps) {
    const auto run = [](int count) {
      Eigen::Vector3d w(0.3, -0.1, 0);
      for (int s = 0; s < count; ++s) w = slipAfter(w, {0, 0.02, 0}, 0.5, 0.1, 0.4 / count);
      return w;
    };
    return (run(steps) - run(1 << 14)).norm();
  };
  EXPECT_NEAR(error(32) / error(64), 2, 0.2);
}

TEST(Drag, TableReproducesTheLaw) {
  // Linear in ln r between 256 nodes a decade; at the law's kinks half a spacing (0.0045) times the jump in
  // slope.
  constexpr double kTable = 4.5e-3;
  for (const DragLaw law : {DragLaw::contaminated, DragLaw::clean}) {
    FoamParams params = waterParams(Preset::physical);
    params.dragLaw = law;
    const DragLawTable table(params);
    for (double r = 3e-5; r < 2e-2; r *= 1.37) {
      const double exact = 0.5 * std::numbers::pi * params.density *
                           dragCoefficientAt(params, 2 * r, terminalSpeed(params, 2 * r));
      EXPECT_NEAR(table(r), exact, kTable * exact) << r;
    }
  }
}

TEST(Drag, PaperCoefficientGivesWayToThePhysicalLawAboveItsLimit) {
  const FoamParams paper = makePreset(Preset::paper), physical = makePreset(Preset::physical);
  const DragLawTable paperTable(paper), physicalTable(physical);
  EXPECT_EQ(paperTable(2.4e-3), 500);
  EXPECT_DOUBLE_EQ(paperTable(4e-3), physicalTable(4e-3));
}

TEST(AirDrag, IsStokesOrTheCoefficient) {
  FoamParams params = makePreset(Preset::physical);
  EXPECT_DOUBLE_EQ(airDragFactor(params, 1e-3), 6 * std::numbers::pi * 1.8e-5 * 1e-3);
  params.airDragLaw = AirDragLaw::coefficient;
  EXPECT_EQ(airDragFactor(params, 1e-3), params.airDragCoefficient);
}

TEST(LiquidAdhesion, IsMonotoneSaturatesAndHasItsSlope) {
  for (const StepStart start : {StepStart::immersed, StepStart::afloat, StepStart::aloft}) {
    double before = 1;
    for (double phi = -3.05e-3; phi < 3e-3; phi += 1e-4) {
      const double force = liquidAdhesion(0.3, phi, 1e-3, start);
      EXPECT_LE(force, before);
      EXPECT_GE(force, -0.3e-3);
      EXPECT_NEAR(liquidAdhesionSlope(0.3, phi, 1e-3, start),
                  slopeOf([&](double x) { return liquidAdhesion(0.3, x, 1e-3, start); }, phi, 1e-8),
                  kDifference);
      before = force;
    }
  }
  EXPECT_DOUBLE_EQ(liquidAdhesion(0.3, 0.5e-3, 1e-3, StepStart::afloat),
                   -0.15e-3);  // down, back to the surface
  EXPECT_DOUBLE_EQ(liquidAdhesion(0.3, -0.5e-3, 1e-3, StepStart::afloat), 0.15e-3);
  EXPECT_EQ(liquidAdhesion(0.3, -0.5e-3, 1e-3, StepStart::immersed), 0);
}

TEST(WallContact, PushesOutWithItsSlope) {
  EXPECT_DOUBLE_EQ(wallContact(20, 0.4e-3, 1e-3), 20 * 0.6e-3);
  EXPECT_NEAR(wallContactSlope(20), slopeOf([](double x) { return wallContact(20, x, 1e-3); }, 0.4e-3, 1e-8),
              1e-5);
}

TEST(StrongSpring, RestLengthIsPlateaus) {
  for (const double lambda : {0.0, 0.4, 1.0}) {
    const double ri = 1.0, rj = 0.7, l = restLength(ri, rj, lambda);
    // The radii meet at the angle with cosine (1 - 3 lambda) / 2 (accuracy, 4.1).
    EXPECT_NEAR((ri * ri + rj * rj - l * l) / (2 * ri * rj), (1 - 3 * lambda) / 2, 1e-15);
  }
}

TEST(StrongSpring, TensionHasItsSlopeOnBothSides) {
  const double ri = 1e-3, rj = 0.8e-3, area = 1e-7;
  const auto tension = [&](double d) { return strongSpring(2, ri, rj, 0.4, d, area).tension; };
  const double rest = restLength(ri, rj, 0.4);
  for (const double d : {0.3 * rest, 0.9 * rest, 1.1 * rest, 1.2 * rest})
    EXPECT_NEAR(strongSpring(2, ri, rj, 0.4, d, area).along, slopeOf(tension, d, 1e-9), 1e-5);
  EXPECT_LT(tension(0.9 * rest), 0);  // pushes
  EXPECT_GT(tension(1.1 * rest), 0);  // pulls
  EXPECT_NEAR(strongSpring(2, ri, rj, 0.4, 1.1 * rest, area).across, tension(1.1 * rest) / (1.1 * rest),
              1e-15);
  EXPECT_EQ(strongSpring(2, ri, rj, 0.4, 0.9 * rest, area).across, 0);  // negative stiffness is dropped
}

TEST(StrongSpring, CompressedPushesWithoutFilmStretchedPullsWithItsFilm) {
  const double r = 1e-3, rest = restLength(r, r, 0.4), restArea = filmDiscArea(r, r, rest);
  EXPECT_LT(strongSpring(2, r, r, 0.4, 0.8 * rest, 0).tension, 0);
  EXPECT_EQ(strongSpring(2, r, r, 0.4, 1.1 * rest, 0).tension, 0);
  const double full = strongSpring(2, r, r, 0.4, 1.1 * rest, restArea).tension;
  EXPECT_NEAR(strongSpring(2, r, r, 0.4, 1.1 * rest, 0.05 * restArea).tension, 0.5 * full, 1e-12);
  EXPECT_EQ(strongSpring(2, r, r, 0.4, 1.1 * rest, 0.1 * restArea).tension, full);
}

TEST(StrongSpring, StiffnessHasTheFloorOfBuoyancy) {
  const FoamParams paper = makePreset(Preset::paper), physical = makePreset(Preset::physical);
  EXPECT_EQ(springStiffness(paper, 1e-3, 1e-3), 2);
  EXPECT_DOUBLE_EQ(springStiffness(paper, 5e-3, 5e-3), 20 * 1000 * 9.8 * 25e-6);
  EXPECT_DOUBLE_EQ(springStiffness(physical, 1e-4, 1e-4), 2 * std::numbers::pi * 0.0728 * 0.75);
}

TEST(StrongSpring, WetnessFallsWithHeight) {
  FoamParams params;
  params.wetness = 0.6, params.wetnessAloft = 0.2, params.wetnessHeight = 0.02;
  EXPECT_DOUBLE_EQ(wetnessAt(params, -0.1, 0.9), 0.6);
  EXPECT_DOUBLE_EQ(wetnessAt(params, 0.01, 0.9), 0.4);
  EXPECT_DOUBLE_EQ(wetnessAt(params, 1, 0.9), 0.2);
}

TEST(StrongSpring, WetnessMayBeTheSameEverywhereOrEachBubblesOwn) {
  FoamParams params;
  params.wetness = 0.6, params.wetnessAloft = 0.2, params.wetnessHeight = 0.02;
  params.wetnessLaw = WetnessLaw::constant;
  EXPECT_DOUBLE_EQ(wetnessAt(params, 1, 0.9), 0.6);
  params.wetnessLaw = WetnessLaw::perBubble;
  EXPECT_DOUBLE_EQ(wetnessAt(params, 1, 0.9), 0.9);
  EXPECT_DOUBLE_EQ(wetnessAt(params, 1, -1), 0.6);
}

TEST(ContactDamping, IsTheCriticalShareOfThePair) {
  // Two masses m on a spring k have reduced mass m/2: critical at 2 sqrt(k m / 2).
  EXPECT_DOUBLE_EQ(contactDamping(0.5, 8, 2, 2), std::sqrt(8.0));
}

TEST(VolumeResponse, IsTheSwellingOfTheRestLengthAndGrowsAsTheFreeSurfaceShrinks) {
  // Equal balls of radius 1: d l / d r_i = (1 + (3 lambda - 1)/2) / l with l^2 = 1 + 3 lambda.
  const SqueezedBubble free{1, 0.3, 9}, squeezed{1, 0.3, 4.5};
  const auto slope = [](double wetness) { return (1 + (3 * wetness - 1) / 2) / std::sqrt(1 + 3 * wetness); };
  const double dry = volumeResponse(free, free, 0);
  EXPECT_GT(dry, 0);
  for (const double wetness : {0.2, 1.0 / 3, 0.7, 1.0})
    EXPECT_NEAR(volumeResponse(free, free, wetness) / dry, slope(wetness) / slope(0), 1e-12) << wetness;
  EXPECT_NEAR(volumeResponse(squeezed, squeezed, 0.4) / volumeResponse(free, free, 0.4), 2, 1e-12);
  EXPECT_EQ(volumeResponse(free, squeezed, 0.4), volumeResponse(squeezed, free, 0.4));
}

}  // namespace
}  // namespace spume::foam::test
