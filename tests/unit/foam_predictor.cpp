// The lone step and its linear form.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "foam/counter_random.h"
#include "foam/forces/buoyancy.h"
#include "foam/predictor.h"
#include "tests/foam_fixtures.h"

namespace spume::foam::test {
namespace {

/// A 1 mm bubble at height phi [m] above a flat surface.
LoneBubble bubbleNear(double phi, const Eigen::Vector3d& velocity) {
  const double r = 1e-3, gas = ballVolume(r);
  LoneBubble b;
  b.velocity = velocity, b.radius = r, b.phi = phi, b.phiSlope = 1, b.up = Eigen::Vector3d::UnitY();
  b.start = stepStart(phi, r), b.immersed = immersedFraction(phi, r);
  b.mass = (1.2 + 500 * b.immersed + 60 * (1 - b.immersed)) * gas;
  b.weight = {0, -(1.2 + 60 * (1 - b.immersed)) * gas * 9.8, 0};
  b.fullBuoyancy = {0, 1000 * gas * 9.8, 0};
  b.adhesion = 0.3, b.drag = b.immersed * 950 * r * r, b.airDrag = (1 - b.immersed) * 3e-7;
  b.liquidVelocity.setZero();
  return b;
}

TEST(Predictor, SatisfiesBackwardEulerAtTheSurface) {
  constexpr double kRoot = 1e-9;  // relative to the impulse of buoyancy: three sweeps of the two directions
  for (const double phi : {-1.0e-3, -0.3e-3, 0.2e-3, 0.9e-3})
    for (const double dt : {0.001, 0.02})
      for (const Eigen::Vector3d& v : {Eigen::Vector3d(0, 0.2, 0), Eigen::Vector3d(0.05, -0.1, 0.02)}) {
        const LoneBubble b = bubbleNear(phi, v);
        const Eigen::Vector3d end = predictVelocity(b, dt);
        if (std::abs(b.phiAfter(end, dt)) > b.radius) continue;
        const Eigen::Vector3d left = b.mass * (end - b.velocity) - dt * b.force(end, dt);
        EXPECT_LE(std::abs(left.y()), 1e-4 * dt * b.fullBuoyancy.norm()) << phi << " " << dt;
        if (v.x() == 0) {
          EXPECT_LE(left.norm(), kRoot * dt * b.fullBuoyancy.norm()) << phi << " " << dt;
        }
      }
}

TEST(Predictor, MatrixIsSymmetricPositiveDefinite) {
  for (double phi = -3e-3; phi < 3e-3; phi += 0.25e-3)
    for (const double dt : {0.001, 0.02, 1.0}) {
      const LoneBubble b = bubbleNear(phi, {0.1, 0.3, -0.2});
      const LinearMotion motion = linearise(b, predictVelocity(b, dt), dt);
      EXPECT_LE((motion.matrix - motion.matrix.transpose()).norm(), 1e-15 * motion.matrix.norm());
      EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(motion.matrix).eigenvalues().minCoeff(), 0);
    }
}

/// Bubbles thrown through the surface at any angle, among liquid that moves otherwise: what holds them along
/// their change of velocity may be far less than what resists them across it.
TEST(Predictor, MatrixStaysPositiveDefiniteHoweverABubbleIsThrown) {
  for (std::uint64_t draw = 0; draw < 20000; ++draw) {
    CounterRandom random(31, draw, 0);
    const auto within = [&](double size) { return size * (2 * random.uniform() - 1); };
    const double phi = within(1.5e-3);
    LoneBubble b = bubbleNear(phi, {within(2), within(2), within(2)});
    b.liquidVelocity = {within(1), within(1), within(1)};
    b.up = Eigen::Vector3d(within(1), within(1), within(1)).normalized();
    const LinearMotion motion = linearise(b, predictVelocity(b, 0.0167), 0.0167);
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(motion.matrix).eigenvalues().minCoeff(), 0)
        << draw;
  }
}

TEST(Predictor, HoldingABubbleNeedsExactlyItsForce) {
  // The claim behind the chord: matrix (v0 - v*) = -dt F(v0), here for a bubble held at rest under water and
  // afloat.
  constexpr double kSweeps = 1e-9;
  for (const double phi : {-5e-3, -1.5e-3, -0.4e-3, 0.3e-3}) {
    const LoneBubble b = bubbleNear(phi, {0, 0, 0});
    for (const double dt : {0.001, 0.005, 0.02}) {
      const LinearMotion motion = linearise(b, predictVelocity(b, dt), dt);
      const Eigen::Vector3d impulse = motion.matrix * (b.velocity - motion.velocity),
                            force = dt * b.force(b.velocity, dt);
      EXPECT_LE((impulse + force).norm(), kSweeps * force.norm()) << phi << " " << dt;
    }
  }
}

TEST(Predictor, FreeFlightIsAParabola) {
  LoneBubble b = bubbleNear(0.5, {0.1, 0, 0});
  b.airDrag = 0;
  EXPECT_NEAR(predictVelocity(b, 0.01).y(), -0.098, 1e-15);
  EXPECT_EQ(predictVelocity(b, 0.01).x(), 0.1);
}

TEST(LoneBubble, SurfaceStiffnessIsTheSlopeOfTheSurfaceForce) {
  constexpr double kStep = 1e-9, kDifference = 1e-5;  // [m]; central differences of a cubic over a radius
  for (const double start : {-2e-3, -0.5e-3, 0.4e-3}) {
    const LoneBubble b = bubbleNear(start, {0, 0, 0});
    for (const double phi : {-0.8e-3, -0.3e-3, 0.2e-3, 0.7e-3}) {
      const double slope =
          (b.surfaceForce(phi + kStep) - b.surfaceForce(phi - kStep)).dot(b.up) / (2 * kStep);
      EXPECT_NEAR(b.surfaceStiffness(phi), slope, kDifference * std::abs(slope)) << start << " " << phi;
      EXPECT_LT(b.surfaceStiffness(phi), 0);
    }
  }
}

TEST(LoneBubble, EveryDragOpposesItsSlip) {
  const Eigen::Vector3d v(0.1, 0, -0.05), stream(0.02, 0.03, 0);
  LoneBubble b = bubbleNear(0, {0, 0, 0});
  b.liquidVelocity = stream;
  const auto added = [&](double LoneBubble::*coefficient, double value) -> Eigen::Vector3d {
    LoneBubble with = b, without = b;
    with.*coefficient = value, without.*coefficient = 0;
    return with.force(v, 0) - without.force(v, 0);
  };
  const Eigen::Vector3d slip = v - stream;
  constexpr double kRound = 1e-12;  // of the force, beside the bubble's buoyancy
  EXPECT_LE((added(&LoneBubble::viscousDrag, 2e-3) + 2e-3 * slip).norm(), kRound);
  EXPECT_LE((added(&LoneBubble::airDrag, 3e-3) + 3e-3 * v).norm(), kRound);
  EXPECT_LE((added(&LoneBubble::drag, 4e-2) + 4e-2 * slip.norm() * slip).norm(), kRound);
}

}  // namespace
}  // namespace spume::foam::test
