#include <gtest/gtest.h>

#include <cmath>

#include "coupling/time_step.h"

namespace spume::coupling {
namespace {

TEST(TimeStep, RestOfTheFrameIsSplitEvenly) {
  const TimeSpec time;
  const double frame = 1 / time.fps;
  EXPECT_DOUBLE_EQ(sharedTimeStep(time, 0.015, frame), frame / 3);
  EXPECT_DOUBLE_EQ(sharedTimeStep(time, 0.0168, frame), frame / 2);
}

TEST(TimeStep, LimitsOfTheSceneHold) {
  const TimeSpec time;
  EXPECT_LE(sharedTimeStep(time, 1, 1), time.maxDt);
  EXPECT_DOUBLE_EQ(sharedTimeStep(time, 1e-9, 10 * time.minDt), time.minDt);
}

TEST(TimeStep, StepsSumToTheFrameWithoutASliver) {
  const TimeSpec time;
  double remaining = 1 / time.fps;
  int steps = 0;
  for (; remaining > 1e-15; ++steps) {
    const double dt = sharedTimeStep(time, 0.009, remaining);
    EXPECT_GT(dt, 0.5 * time.minDt);
    remaining -= dt;
  }
  EXPECT_EQ(steps, 4);
}

}  // namespace
}  // namespace spume::coupling
