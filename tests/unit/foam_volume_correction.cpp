// Volume correction as a rate.
#include <gtest/gtest.h>

#include "foam/volume_correction.h"
#include "tests/foam_fixtures.h"

namespace spume::foam::test {
namespace {

const Eigen::VectorXd kNoWall = Eigen::VectorXd::Constant(1, 1.0);

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
        correctVolumes(params, cellOf(bubbles, 1), kNoWall, dt, bubbles);
      const double exact = 1e-3 * std::pow(0.8, std::exp(-gamma * 0.3));
      EXPECT_NEAR(bubbles.radius[0], exact, 1e-12);
    }
}

TEST(VolumeCorrection, StopsAtTheLimitAndSaysSo) {
  BubbleStore bubbles;
  bubbles.add(bubbleAt({0, 0, 0}, 1e-3));
  for (int step = 0; step < 1000; ++step)
    correctVolumes(FoamParams(), cellOf(bubbles, 1e-3), kNoWall, 0.02, bubbles);
  EXPECT_DOUBLE_EQ(bubbles.radius[0], 2e-3);
  EXPECT_EQ(bubbles.clamped[0], 1);
  correctVolumes(FoamParams(), cellOf(bubbles, 0.9), kNoWall, 0.02, bubbles);
  EXPECT_EQ(bubbles.clamped[0], 0);
}

TEST(VolumeCorrection, AHiddenBubbleKeepsItsGasAndReturnsToItsOwnSize) {
  BubbleStore bubbles;
  bubbles.add(bubbleAt({0, 0, 0}, 1e-3));
  bubbles.radius[0] = 1.7e-3;
  const double gas = bubbles.gas[0];
  FoamTopology topology = cellOf(bubbles, 0, true);
  for (int step = 0; step < 500; ++step) correctVolumes(FoamParams(), topology, kNoWall, 0.02, bubbles);
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
  correctVolumes(params, cellOf(bubbles, 1), kNoWall, 0.02, bubbles);
  EXPECT_EQ(bubbles.radius[0], 0.8e-3);
  params.volumeRate = 1000;
  correctVolumes(params, cellOf(bubbles, 1), kNoWall, 1, bubbles);
  EXPECT_NEAR(bubbles.radius[0], 1e-3, 1e-15);
}

TEST(VolumeCorrection, OfABubbleOnAWallOnlyTheFreePartCounts) {
  EXPECT_DOUBLE_EQ(freeShare(0, 1e-3), 0.5);
  EXPECT_DOUBLE_EQ(freeShare(2e-3, 1e-3), 1);
  EXPECT_NEAR(freeShare(0.3e-3, 1e-3), 1 - 0.49 * 2.3 / 4, 1e-15);  // the ball less a cap of height 0.7 r
  BubbleStore bubbles;
  bubbles.add(bubbleAt({0, 0, 0}, 1e-3));
  const Eigen::VectorXd onWall = Eigen::VectorXd::Zero(1);
  for (int step = 0; step < 500; ++step)
    correctVolumes(FoamParams(), cellOf(bubbles, 1), onWall, 0.02, bubbles);
  EXPECT_NEAR(bubbles.radius[0], 1e-3 * std::cbrt(2.0), 1e-12);  // a half ball that holds the gas
}

}  // namespace
}  // namespace spume::foam::test
