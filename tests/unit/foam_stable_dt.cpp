// The step the foam asks for, from pairs of known relative speed.
#include <gtest/gtest.h>

#include "foam/foam_solver.h"
#include "foam/presets.h"
#include "foam/still_pool.h"

namespace spume::foam {
namespace {

constexpr double kRadius = 1e-3, kSpeed = 0.2, kInstant = 1e-6;  // [m], [m/s], [s]
/// Forces of a step of 1e-6 s: springs and drag change speeds at 1e2 to 1e3 per second.
constexpr double kTolerance = 1e-2;

/// Overlapping pairs, far from each other; the partners of the first `fast` part at kSpeed.
double stableDtOf(int pairs, int fast) {
  FoamParams params = makePreset(Preset::physical);
  params.gravity.setZero();
  StillPoolParams box;
  box.lower.setConstant(-1), box.upper.setConstant(1), box.surfaceHeight = 0.5;
  box.gravity = params.gravity;
  BubbleStore bubbles;
  for (int p = 0; p < pairs; ++p) {
    const Eigen::Vector3d at(10 * kRadius * p, 0, 0);
    bubbles.add({.position = at, .radius = kRadius});
    const Eigen::Vector3d away(0, p < fast ? kSpeed : 0, 0);
    bubbles.add({.position = at + Eigen::Vector3d(0, 1.9 * kRadius, 0), .velocity = away, .radius = kRadius});
  }
  FoamSolver solver(params);
  solver.step(bubbles, StillPool(box), kInstant);
  return solver.stableDt(bubbles);
}

TEST(StableDt, LetsAFastPairMoveHalfARadius) {
  const double expected = 0.5 * kRadius / kSpeed;
  EXPECT_NEAR(stableDtOf(1, 1), expected, kTolerance * expected);
  EXPECT_NEAR(stableDtOf(40, 40), expected, kTolerance * expected);
}

TEST(StableDt, AFewArrivalsDoNotSetTheStepOfAll) {
  constexpr double kMuchLonger = 5;
  EXPECT_GT(stableDtOf(40, 1), kMuchLonger * stableDtOf(1, 1));
  const double expected = 0.5 * kRadius / kSpeed;
  EXPECT_NEAR(stableDtOf(40, 4), expected, kTolerance * expected);  // one in ten
}

}  // namespace
}  // namespace spume::foam
