#include <gtest/gtest.h>

#include "foam/still_pool.h"
#include "foam/wall_limit.h"

namespace spume::foam {
namespace {

/// Round-off of the places and speeds below, all within 1.
constexpr double kRoundOff = 1e-14;

/// Water over a floor at y = 0.
StillPool floored() {
  StillPoolParams params;
  params.lower = {-1, 0, -1};
  params.surfaceHeight = 0.5;
  params.closed[2] = true;
  return StillPool(params);
}

TEST(WallLimit, ABubbleThrownIntoTheFloorComesBackToItsEdge) {
  const double r = 0.01;
  BubbleStore bubbles;
  bubbles.add({{0.1, -0.5 * r, 0.2}, {0.3, -0.4, 0}, r});
  Eigen::VectorXd psi;
  EXPECT_EQ(keepOutOfSolids(floored(), bubbles, psi), 1u);
  EXPECT_NEAR(bubbles.position[0].y(), -kDeepestInSolid * r, kRoundOff);
  EXPECT_EQ(bubbles.position[0].x(), 0.1);
  EXPECT_NEAR((bubbles.velocity[0] - Eigen::Vector3d(0.3, 0, 0)).norm(), 0, kRoundOff);
}

TEST(WallLimit, OneThatComesOutKeepsItsVelocity) {
  BubbleStore bubbles;
  bubbles.add({{0, -0.005, 0}, {0, 0.4, 0}, 0.01});
  Eigen::VectorXd psi;
  keepOutOfSolids(floored(), bubbles, psi);
  EXPECT_EQ(bubbles.velocity[0], Eigen::Vector3d(0, 0.4, 0));
}

TEST(WallLimit, BubblesOnTheFloorAndAwayFromItAreLeftAlone) {
  BubbleStore bubbles;
  bubbles.add({{0, -0.0005, 0}, {0, -1, 0}, 0.01});
  bubbles.add({{0, 0.3, 0}, {0, -1, 0}, 0.01});
  Eigen::VectorXd psi;
  EXPECT_EQ(keepOutOfSolids(floored(), bubbles, psi), 0u);
  EXPECT_EQ(bubbles.position[0].y(), -0.0005);
  EXPECT_EQ(bubbles.velocity[1].y(), -1);
}

TEST(WallLimit, TellsHowFarAllAreFromSolidsWhereTheyThenAre) {
  BubbleStore bubbles;
  for (const double height : {0.3, -0.005, -0.0005, 0.2}) bubbles.add({{0, height, 0}, {0, -1, 0}, 0.01});
  Eigen::VectorXd psi, there(4);
  EXPECT_EQ(keepOutOfSolids(floored(), bubbles, psi), 1u);
  floored().psi(bubbles.positions(), there);
  EXPECT_EQ(psi, there);
  EXPECT_NEAR(psi[1], -kDeepestInSolid * 0.01, kRoundOff);
}

}  // namespace
}  // namespace spume::foam
