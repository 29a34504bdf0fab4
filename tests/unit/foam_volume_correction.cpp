// Volume correction as a rate.
#include <gtest/gtest.h>

#include "foam/volume_correction.h"
#include "foam/volume_newton.h"
#include "tests/foam_fixtures.h"
#include "tests/support/foam_balls.h"
#include "tests/support/foam_dense.h"
#include "tests/support/foam_relaxed.h"

namespace spume::foam::test {
namespace {

/// Relative error the Newton steps are driven to here: far above round-off, far below what linearising
/// leaves.
constexpr double kVolumeTolerance = 1e-8;

double worstVolumeError(const BubbleStore& bubbles) {
  double worst = 0;
  for (const std::int32_t i : cellsOff(bubbles, 0))
    worst = std::max(worst, std::abs(bubbles.volume[i] / bubbles.gas[i] - 1));
  return worst;
}

/// One bubble whose cell is the share `share` of its ball.
FoamTopology cellOf(const BubbleStore& bubbles, double share, bool hidden = false) {
  FoamTopology topology;
  topology.volume = {share * ballVolume(bubbles.radius[0])};
  topology.hidden = {hidden};
  return topology;
}

TEST(VolumeCorrection, RateDoesNotDependOnTheStep) {
  // A ball alone: ln (V0/V) decays as exp(-gamma t) exactly, in steps of any length.
  FoamParams params;
  for (const double gamma : {1.0, 10.0})
    for (const double dt : {0.001, 0.005, 0.02, 0.1}) {
      params.volumeRate = gamma;
      BubbleStore bubbles;
      bubbles.add(bubbleAt({0, 0, 0}, 1e-3));
      bubbles.radius[0] = 0.8e-3;
      for (int step = 0; step < std::lround(0.3 / dt); ++step)
        correctVolumes(params, cellOf(bubbles, 1), dt, bubbles);
      const double exact = 1e-3 * std::pow(0.8, std::exp(-gamma * 0.3));
      EXPECT_NEAR(bubbles.radius[0], exact, 1e-12);
    }
}

TEST(VolumeCorrection, StopsAtTheLimitAndSaysSo) {
  BubbleStore bubbles;
  bubbles.add(bubbleAt({0, 0, 0}, 1e-3));
  for (int step = 0; step < 1000; ++step) correctVolumes(FoamParams(), cellOf(bubbles, 1e-3), 0.02, bubbles);
  EXPECT_DOUBLE_EQ(bubbles.radius[0], 2e-3);
  EXPECT_EQ(bubbles.clamped[0], 1);
  correctVolumes(FoamParams(), cellOf(bubbles, 0.9), 0.02, bubbles);
  EXPECT_EQ(bubbles.clamped[0], 0);
}

TEST(VolumeCorrection, AHiddenBubbleKeepsItsGasAndReturnsToItsOwnSize) {
  BubbleStore bubbles;
  bubbles.add(bubbleAt({0, 0, 0}, 1e-3));
  bubbles.radius[0] = 1.7e-3;
  const double gas = bubbles.gas[0];
  FoamTopology topology = cellOf(bubbles, 0, true);
  for (int step = 0; step < 500; ++step) correctVolumes(FoamParams(), topology, 0.02, bubbles);
  EXPECT_NEAR(bubbles.radius[0], 1e-3, 1e-12);
  EXPECT_EQ(bubbles.gas[0], gas);
  EXPECT_EQ(bubbles.hidden[0], 1);
}

TEST(VolumeCorrection, VanishingRateChangesNothingAndAHugeOneOvershootsNothing) {
  FoamParams params;
  BubbleStore bubbles;
  bubbles.add(bubbleAt({0, 0, 0}, 1e-3));
  bubbles.radius[0] = 0.8e-3;
  params.volumeRate = 0;
  correctVolumes(params, cellOf(bubbles, 1), 0.02, bubbles);
  EXPECT_EQ(bubbles.radius[0], 0.8e-3);
  params.volumeRate = 1000;
  correctVolumes(params, cellOf(bubbles, 1), 1, bubbles);
  EXPECT_NEAR(bubbles.radius[0], 1e-3, 1e-15);
}

TEST(VolumeCorrection, NewtonSolvesTheCellsOfAFoamTogether) {
  // The drawn radii are off by 2 %; each step squares what is left.
  BubbleStore bubbles = denseFoam();
  for (std::size_t i = 0; i < bubbles.size(); ++i)
    bubbles.radius[i] *= 1 + 0.02 * (CounterRandom(1, i, 1).uniform() - 0.5);
  FoamParams params;
  params.volumeMode = VolumeMode::newton;
  params.radiusLimit = 10;  // random balls overlap far more than a foam that has settled
  std::vector<double> errors;
  for (int step = 0; step < 6; ++step) {
    FoamTopology topology;
    Neighbours neighbours;
    measure(bubbles, topology, neighbours);
    errors.push_back(worstVolumeError(bubbles));
    projectVolumes(params, topology, neighbours, {}, bubbles);
  }
  EXPECT_GT(errors[0], 0.01);
  EXPECT_LT(errors[2], 0.05 * errors[0]);
  EXPECT_LT(errors[5], kVolumeTolerance);
}

TEST(VolumeCorrection, NewtonHoldsTheNeighboursOfBallsAtTheirLimit) {
  // The tenth of the balls that needs the most room is not given it; all others can still hold their gas.
  BubbleStore bubbles = denseFoam();
  std::vector<double> stretch;
  for (std::size_t i = 0; i < bubbles.size(); ++i)
    if (bubbles.gas[i] > 1e-15)
      stretch.push_back(bubbles.radius[i] / gasRadius(bubbles.gas[i]));  // not hidden
  std::sort(stretch.begin(), stretch.end());
  FoamParams params;
  params.volumeMode = VolumeMode::newton;
  params.radiusLimit = stretch[stretch.size() * 9 / 10];
  for (int step = 0;; ++step) {
    FoamTopology topology;
    Neighbours neighbours;
    measure(bubbles, topology, neighbours);
    if (step == 12) break;
    projectVolumes(params, topology, neighbours, {}, bubbles);
  }
  EXPECT_GT(std::count(bubbles.clamped.begin(), bubbles.clamped.end(), 1), 10);
  EXPECT_LT(worstVolumeError(bubbles), kVolumeTolerance);
}

TEST(VolumeCorrection, NewtonBringsBackACellThatIsAllButCoveredOrLetGo) {
  // One ball of 30 shrunk to its gas alone, another swollen by half: cells that vanish and cells 3 times too
  // large are both brought back, without a radius below that of the free gas.
  BubbleStore bubbles = denseFoam();
  std::vector<std::int32_t> disturbed;
  for (std::size_t i = 0; i < bubbles.size(); i += 15) {
    if (bubbles.gas[i] <= 1e-15) continue;
    bubbles.radius[i] = i % 2 ? 1.5 * bubbles.radius[i] : gasRadius(bubbles.gas[i]);
    disturbed.push_back(static_cast<std::int32_t>(i));
  }
  ASSERT_GT(disturbed.size(), 10u);
  FoamParams params;
  params.volumeMode = VolumeMode::newton;
  params.volumeTolerance = kVolumeTolerance;
  params.radiusLimit = 10;
  FoamTopology topology;
  Neighbours neighbours;
  for (int step = 0;; ++step) {
    measure(bubbles, topology, neighbours);
    if (step == 20) break;
    projectVolumes(params, topology, neighbours, {}, bubbles);
  }
  EXPECT_LT(worstVolumeError(bubbles), kVolumeTolerance);
  for (const std::int32_t i : disturbed) {
    if (!bubbles.hidden[i]) {
      EXPECT_GE(bubbles.radius[i], gasRadius(bubbles.gas[i])) << i;
    }
  }
}

TEST(VolumeCorrection, WhatACellLosesToOneThatGrowsIsWhatIsMeasured) {
  const BubbleStore foam = denseFoam();
  const std::size_t odd = foam.size() / 2;
  FoamTopology topology;
  Neighbours neighbours;
  std::vector<double> change(foam.size(), 0.0);
  BubbleStore bubbles = foam;
  measure(bubbles, topology, neighbours);
  const std::vector<double> before = topology.volume;
  constexpr double kGrowth = 1e-5;
  change[odd] = std::pow(kGrowth * foam.radius[odd], 2) + 2 * kGrowth * std::pow(foam.radius[odd], 2);
  std::vector<double> lost(foam.size());
  for (std::size_t i = 0; i < foam.size(); ++i) lost[i] = volumeLost(topology, neighbours, change, i);
  bubbles.radius[odd] *= 1 + kGrowth;
  measure(bubbles, topology, neighbours);
  std::size_t disturbed = 0;
  for (std::size_t i = 0; i < foam.size(); ++i) {
    if (i == odd) continue;
    disturbed += lost[i] > 0;
    EXPECT_NEAR(before[i] - topology.volume[i], lost[i], 1e-3 * lost[i] + 1e-9 * before[i]) << i;
  }
  EXPECT_GE(disturbed, 2u);
}

TEST(VolumeCorrection, NewtonHoldsVolumesWhileBubblesMove) {
  // Two bubbles run into each other: V of both stays V0, however fast their cells change.
  FoamParams params = makePreset(Preset::physical);
  params.volumeMode = VolumeMode::newton, params.bursting = false;
  params.volumeTolerance = kVolumeTolerance;
  params.gravity.setZero();
  for (const double dt : {0.001, 0.02}) {
    BubbleStore bubbles;
    bubbles.add(bubbleAt({-1.1e-3, 0, 0}, 1e-3, {0.05, 0, 0}));
    bubbles.add(bubbleAt({1.1e-3, 0, 0}, 1e-3, {-0.05, 0, 0}));
    FoamSolver solver(params);
    std::size_t met = 0;
    for (double t = 0; t < 0.1; t += dt) {
      const FoamStepReport report = solver.step(bubbles, emptySpace(), dt);
      met += report.contacts;
      EXPECT_LE(report.volumeErrorMax, kVolumeTolerance) << dt << " " << t;
    }
    EXPECT_GT(met, 0u);
  }
}

TEST(VolumeCorrection, NewtonHoldsTheNeighboursOfWhatBurstsAndTheHeirsOfWhatMerges) {
  // A foam in free space falls apart: measured anew after every step, what is left holds its gas.
  constexpr double kStep = 0.01;
  constexpr double kLeastShare = 0.3;  // of its ball a bubble's gas fills, for those the foam has swallowed
  FoamParams params = makePreset(Preset::physical);
  params.volumeMode = VolumeMode::newton, params.volumeTolerance = 1e-4;
  params.burstMedianLife = 5 * kStep;
  params.gravity.setZero();
  BubbleStore bubbles;
  const Balls balls = relaxedFoam(500, 0.2, 3);
  const FoamTopology start = powerCellsOf(balls);
  for (std::size_t i = 0; i < balls.size(); ++i) {
    bubbles.add(bubbleAt(balls.position[i], balls.radius[i]));
    bubbles.gas.back() = std::max(start.volume[i], kLeastShare * ballVolume(balls.radius[i]));
  }
  FoamSolver solver(params);
  int merged = 0, burst = 0, judged = 0;
  for (int step = 0; step < 8; ++step) {
    const FoamStepReport report = solver.step(bubbles, emptySpace(), kStep);
    for (const FoamEvent& event : report.events)
      merged += event.kind == FoamEventKind::merge, burst += event.kind == FoamEventKind::burst;
    EXPECT_EQ(solver.topologyIds().size(), bubbles.size());
    Balls left;
    for (std::size_t i = 0; i < bubbles.size(); ++i) left.add(bubbles.position[i], bubbles.radius[i]);
    const FoamTopology cells = powerCellsOf(left);
    for (std::size_t i = 0; i < bubbles.size(); ++i) {
      if (bubbles.hidden[i] || bubbles.clamped[i]) continue;
      EXPECT_NEAR(cells.volume[i] / bubbles.gas[i], 1, params.volumeTolerance) << step << " " << i;
      ++judged;
    }
  }
  EXPECT_GT(merged, 3);
  EXPECT_GT(burst, 20);
  EXPECT_GT(judged, 200);
}

TEST(VolumeCorrection, WeightChangesAreTheInverseOfTheDerivatives) {
  // accuracy, V2: dV0/dw1 = -.325794794, dV1/dw1 = 3.257947937.
  Balls balls;
  balls.add({0, 0, 0}, 1), balls.add({1.2, 0, 0}, 0.6);
  const FoamTopology cells = powerCellsOf(balls);
  Neighbours neighbours;
  neighbours.build(balls.size(), cells.overlaps);
  std::vector<double> change;
  solveWeightChanges(cells, neighbours, balls.radius, {-0.325794794e-3, 3.257947937e-3}, {0, 0}, 1e-12,
                     change);
  EXPECT_NEAR(change[0], 0, 1e-9);
  EXPECT_NEAR(change[1], 1e-3, 1e-9);
  solveWeightChanges(cells, neighbours, balls.radius, {1, 2 * 3.257947937e-3}, {1, 0}, 1e-12, change);
  EXPECT_EQ(change[0], 0);  // whatever it wants
  EXPECT_NEAR(change[1], 2e-3, 1e-9);
}

}  // namespace
}  // namespace spume::foam::test
