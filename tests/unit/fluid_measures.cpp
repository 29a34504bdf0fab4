#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "fluid/liquid_measures.h"
#include "tests/support/fluid_fields.h"

namespace spume::fluid {
namespace {

using namespace test;

/// Liquid fills the lower half of a cube of 20 cells.
struct HalfFull {
  GridSpec grid = unitCube(20);
  DenseField<float> phi = levelSet(grid, [](const auto& x) { return x.y() - 0.5; });
  MacVelocity velocity{grid.cells, 0.25f};
};

TEST(MaxFaceSpeed, IsThatOfTheFastestFaceOfALiquidCell) {
  for (int axis = 0; axis < 3; ++axis)
    for (const int upper : {0, 1}) {
      HalfFull water;
      water.velocity[axis](Eigen::Vector3i(7, 15, 19)) = 9;  // in air
      water.velocity[axis](Eigen::Vector3i(7, 4, 19) + upper * Eigen::Vector3i::Unit(axis)) = -3;
      EXPECT_EQ(maxFaceSpeed(water.phi, water.velocity), 3) << axis << ' ' << upper;
    }
}

TEST(MaxFaceSpeed, DoesNotHideWhatIsNoNumber) {
  HalfFull water;
  const float none = std::numeric_limits<float>::quiet_NaN();
  water.velocity[2](3, 15, 5) = none;  // in air
  EXPECT_EQ(maxFaceSpeed(water.phi, water.velocity), 0.25);
  water.velocity[2](3, 4, 5) = none;
  water.velocity[0](9, 4, 5) = 100;
  EXPECT_TRUE(std::isnan(maxFaceSpeed(water.phi, water.velocity)));
}

TEST(MaxInnerSpeed, CountsFacesInLiquidAndUpToItsSurfaceAlone) {
  for (int axis = 0; axis < 3; ++axis) {
    HalfFull water;
    water.phi = levelSet(water.grid, [](const auto& x) { return x.y() - 0.48; });  // at 9.6 cells
    water.velocity[axis](7, 4, 8) = -3;
    water.velocity[1](7, 10, 8) = 9;  // of a wet cell, but in air
    EXPECT_EQ(maxFaceSpeed(water.phi, water.velocity), 9);
    EXPECT_EQ(maxInnerSpeed(water.phi, water.velocity), 3) << axis;
    water.velocity[0](7, 9, 8) = 4;
    EXPECT_EQ(maxInnerSpeed(water.phi, water.velocity), 4);
  }
}

TEST(PresentVelocity, LiesBetweenTheTwoItIsGiven) {
  const GridSpec grid = unitCube(6);
  const MacVelocity earlier(grid.cells, 1), later(grid.cells, 2);
  MacVelocity now;
  presentVelocity(earlier, later, 0.25, now);
  for (int a = 0; a < 3; ++a) EXPECT_EQ(now[a](2, 3, 4), 1.75f);
}

}  // namespace
}  // namespace spume::fluid
