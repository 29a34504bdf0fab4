#include <gtest/gtest.h>

#include <random>

#include "fluid/cut_fractions.h"

namespace spume::fluid {
namespace {

constexpr double kRoundOff = 1e-13;  // a few dozen operations on numbers near 1

TEST(SquareFraction, IsExactForAHalfPlane) {
  EXPECT_NEAR(squareFraction({-0.25, 0.75, 0.75, -0.25}), 0.75, kRoundOff);  // x > 1/4
  EXPECT_NEAR(squareFraction({0.5, -0.5, -1.5, -0.5}), 0.125, kRoundOff);    // x + y < 1/2
  EXPECT_NEAR(squareFraction({-0.5, 0.5, 1.5, 0.5}), 0.875, kRoundOff);
  EXPECT_EQ(squareFraction({1, 1, 1, 1}), 1);
  EXPECT_EQ(squareFraction({-1, -1, -1, 0}), 0);
}

TEST(SquareFraction, OfAFieldAndItsNegativeAddUpToOne) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int n = 0; n < 1000; ++n) {
    std::array<double, 4> field, negative;
    for (int c = 0; c < 4; ++c) negative[c] = -(field[c] = uniform(random));
    EXPECT_NEAR(squareFraction(field) + squareFraction(negative), 1, kRoundOff);
  }
}

TEST(CubeFraction, IsExactForAPlane) {
  std::array<double, 8> corner;
  for (int n = 0; n < 8; ++n) corner[n] = (n & 1) + (n >> 1 & 1) + (n >> 2) - 1.0;  // x + y + z > 1
  EXPECT_NEAR(cubeFraction(corner), 5.0 / 6, kRoundOff);
  for (double& value : corner) value += 0.5;  // x + y + z > 1/2
  EXPECT_NEAR(cubeFraction(corner), 1 - 1.0 / 48, kRoundOff);
}

}  // namespace
}  // namespace spume::fluid
