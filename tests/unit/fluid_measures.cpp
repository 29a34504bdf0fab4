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

}  // namespace
}  // namespace spume::fluid
