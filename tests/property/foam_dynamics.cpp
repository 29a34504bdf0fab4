// Conservation and independence of the whole foam step.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cstring>

#include "tests/foam_fixtures.h"

namespace spume::foam::test {
namespace {

/// n seeded bubbles in a cube of the given edge, with random velocities of size `speed` [m/s].
BubbleStore randomCloud(int n, double edge, double speed, double smallest, double largest, double top = 0) {
  BubbleStore bubbles;
  for (int i = 0; i < n; ++i) {
    CounterRandom random(21, static_cast<std::uint64_t>(i), 0);
    const auto vector = [&](double size) {
      const double x = random.uniform(), y = random.uniform(), z = random.uniform();
      return Eigen::Vector3d(size * (2 * Eigen::Vector3d(x, y, z).array() - 1));
    };
    const Eigen::Vector3d place = vector(edge / 2) + Eigen::Vector3d(0, top - edge / 2, 0);
    bubbles.add(bubbleAt(place, smallest + (largest - smallest) * random.uniform(), vector(speed)));
  }
  return bubbles;
}

Eigen::Vector3d totalMomentum(const BubbleStore& bubbles, const FoamParams& params) {
  // In empty space chi = 0: gas and films.
  const double liquidFraction = 0.36 * params.wetness * params.wetness;
  const double density = params.gasDensity + params.density * liquidFraction / (1 - liquidFraction);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < bubbles.size(); ++i) sum += density * bubbles.gas[i] * bubbles.velocity[i];
  return sum;
}

TEST(FoamDynamics, InternalForcesConserveMomentum) {
  constexpr double kRound = 1e-12;  // of the sum of |m v|: round-off of 200 terms over 50 steps
  for (const Preset preset : {Preset::paper, Preset::physical}) {
    FoamParams params = makePreset(preset);
    params.gravity.setZero();
    params.gasViscosity = 0, params.airDragLaw = AirDragLaw::stokes, params.bursting = false;
    BubbleStore bubbles = randomCloud(200, 8e-3, 0.1, 0.3e-3, 1.2e-3);
    const Eigen::Vector3d before = totalMomentum(bubbles, params);
    const StillPool space = emptySpace();
    FoamSolver solver(params);
    double scale = 0;
    for (std::size_t i = 0; i < bubbles.size(); ++i)
      scale += 60 * bubbles.gas[i] * bubbles.velocity[i].norm();
    for (int step = 0; step < 50; ++step) solver.step(bubbles, space, 0.005);
    EXPECT_LE((totalMomentum(bubbles, params) - before).norm(), kRound * scale);
  }
}

TEST(FoamDynamics, DampingLetsARigidlyMovingClusterPass) {
  // Eq. 10 as printed slows a cluster that moves as one; the pairwise form must not.
  FoamParams params = makePreset(Preset::paper);
  params.gravity.setZero();
  params.airDragCoefficient = 0, params.contactDamping = 5, params.volumeRate = 0, params.bursting = false;
  const double l = std::sqrt(2 + 3 * params.wetness - 1) * 1e-3;
  BubbleStore bubbles;
  for (const double x : {0.0, l}) bubbles.add(bubbleAt({x, 0, 0}, 1e-3, {0.2, -0.1, 0.3}, BubbleClass::air));
  FoamSolver solver(params);
  const StillPool space = emptySpace();
  for (int step = 0; step < 100; ++step) solver.step(bubbles, space, 0.01);
  for (const auto& v : bubbles.velocity) EXPECT_LE((v - Eigen::Vector3d(0.2, -0.1, 0.3)).norm(), 1e-12);
}

/// The store after some steps in a pool, with a given number of threads.
BubbleStore runWithThreads(std::size_t threads) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  FoamParams params = makePreset(Preset::physical);
  params.burstMedianLife = 0.05;
  BubbleStore bubbles = randomCloud(3000, 40e-3, 0, 0.3e-3, 1.5e-3, 1e-3);
  StillPoolParams pool;
  pool.lower = {-21e-3, -60e-3, -21e-3}, pool.upper = {21e-3, 60e-3, 21e-3};
  pool.closed = {true, true, true, true, true, true};
  FoamSolver solver(params);
  for (int step = 0; step < 12; ++step) solver.step(bubbles, StillPool(pool), 0.01);
  return bubbles;
}

template <typename T>
bool sameBits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

TEST(FoamDynamics, ResultIsTheSameToTheBitForAnyNumberOfThreads) {
  const BubbleStore one = runWithThreads(1);
  EXPECT_LT(one.size(), 3000u);  // some have burst
  for (const std::size_t threads : {2, 4, 8}) {
    const BubbleStore many = runWithThreads(threads);
    EXPECT_TRUE(sameBits(one.id, many.id));
    EXPECT_TRUE(sameBits(one.position, many.position));
    EXPECT_TRUE(sameBits(one.velocity, many.velocity));
    EXPECT_TRUE(sameBits(one.radius, many.radius));
    EXPECT_TRUE(sameBits(one.exposure, many.exposure));
  }
}

TEST(FoamDynamics, BothEnginesGiveTheSameSteps) {
  constexpr double kSame = 1e-8;  // of a radius: five steps of a solve to 1e-10
  FoamParams params = makePreset(Preset::physical);
  params.volumeMode = VolumeMode::newton, params.solverTolerance = 1e-10, params.volumeTolerance = 1e-9;
  BubbleStore local = randomCloud(100, 12e-3, 0, 0.3e-3, 1e-3), global = local;
  StillPoolParams box;
  box.lower = {-6e-3, -13e-3, -6e-3}, box.upper = {6e-3, 6e-3, 6e-3};
  box.closed = {true, true, true, false, true, true};
  FoamSolver ofCells(params);
  params.connectivity = Connectivity::global;
  FoamSolver ofDiagram(params);
  for (int step = 0; step < 5; ++step)
    ofCells.step(local, StillPool(box), 0.005), ofDiagram.step(global, StillPool(box), 0.005);
  ASSERT_EQ(local.id, global.id);
  for (std::size_t i = 0; i < local.size(); ++i) {
    EXPECT_LT((local.position[i] - global.position[i]).norm(), kSame * local.radius[i]) << i;
    EXPECT_NEAR(local.radius[i], global.radius[i], kSame * local.radius[i]) << i;
  }
}

TEST(FoamDynamics, TheSolverKeepsNoState) {
  // A fresh solver continues a store as the old one would: a resumed run equals an uninterrupted one.
  const FoamParams params = makePreset(Preset::physical);
  const StillPool pool = openPool(params);
  BubbleStore kept = randomCloud(100, 8e-3, 0, 0.3e-3, 1e-3);
  FoamSolver solver(params);
  for (int step = 0; step < 5; ++step) solver.step(kept, pool, 0.01);
  BubbleStore resumed = kept;
  solver.step(kept, pool, 0.01);
  FoamSolver(params).step(resumed, pool, 0.01);
  EXPECT_TRUE(sameBits(kept.position, resumed.position));
  EXPECT_TRUE(sameBits(kept.velocity, resumed.velocity));
}

TEST(FoamDynamics, EnergyOfARelaxingClusterNeverRises) {
  FoamParams params = makePreset(Preset::paper);
  params.gravity.setZero();
  params.volumeRate = 0, params.bursting = false;
  for (const double dt : {1e-4, 1e-3, 0.02, 0.1, 1.0}) {
    BubbleStore bubbles;
    bubbles.add(bubbleAt({0, 0, 0}, 1e-3, {0.05, 0, 0}, BubbleClass::air));
    bubbles.add(bubbleAt({0.7e-3, 0, 0}, 1e-3, {-0.05, 0, 0}, BubbleClass::air));
    FoamSolver solver(params);
    const StillPool space = emptySpace();
    const double rest = std::sqrt(2 + 3 * params.wetness - 1) * 1e-3;
    constexpr double kRestEnergy = 1e-24;  // [J] of a picometre: what counts as rest is below it
    double before = 1;
    for (int step = 0; step < 200; ++step) {
      const double kinetic = solver.step(bubbles, space, dt).kineticEnergy;
      const double d = (bubbles.position[0] - bubbles.position[1]).norm() - rest;
      const double energy = kinetic + 0.5 * params.springStiffness * d * d;
      ASSERT_LE(energy, before * (1 + 1e-9) + kRestEnergy) << "dt " << dt << " step " << step;
      before = energy;
    }
    EXPECT_NEAR((bubbles.position[0] - bubbles.position[1]).norm(), rest, 1e-5 * rest) << dt;
  }
}

}  // namespace
}  // namespace spume::foam::test
