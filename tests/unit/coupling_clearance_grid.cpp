// Room around new balls, against a look at all others.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "coupling/clearance_grid.h"

namespace spume::coupling {
namespace {

struct Ball {
  Eigen::Vector3d centre;
  double radius;
};

/// As ClearanceGrid::clearance, the long way.
double clearanceAmong(const std::vector<Ball>& balls, const Eigen::Vector3d& x, double radius) {
  double least = 0;
  for (const Ball& ball : balls) least = std::min(least, (x - ball.centre).norm() - ball.radius - radius);
  return least;
}

TEST(ClearanceGrid, IsThatToTheNearestOfAllBalls) {
  constexpr double kUsual = 0.05;  // of a box about 1 wide
  const Eigen::Vector3d lower(-0.3, 0.2, 0), upper(0.7, 0.9, 1.1);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  const auto place = [&](double margin) {
    const Eigen::Array3d share(unit(random), unit(random), unit(random));
    const Eigen::Vector3d low = lower.array() - margin;
    return (low + (share * (upper - lower + Eigen::Vector3d::Constant(2 * margin)).array()).matrix()).eval();
  };
  ClearanceGrid grid(lower, upper, kUsual);
  std::vector<Ball> balls;
  int apart = 0, overlapping = 0;
  for (int n = 0; n < 400; ++n) {
    const double radius =
        kUsual * (n % 50 == 49 ? 5 : 0.2 + unit(random));  // a few far wider than the others
    balls.push_back({place(0.1), radius});                 // beyond the box as well
    grid.add(balls.back().centre, radius);
    const Eigen::Vector3d x = place(0);
    const double own = kUsual * unit(random), expected = clearanceAmong(balls, x, own);
    EXPECT_EQ(grid.clearance(x, own), expected) << n;
    ++(expected < 0 ? overlapping : apart);
  }
  EXPECT_GT(apart, 50);
  EXPECT_GT(overlapping, 50);
}

TEST(ClearanceGrid, OfABoxWithoutRoomKnowsItsBalls) {
  const Eigen::Vector3d corner(1, 2, 3);
  ClearanceGrid grid(corner, corner - Eigen::Vector3d(0, 1, 0), 1e-3);
  EXPECT_EQ(grid.clearance(corner, 1), 0);
  grid.add(corner + Eigen::Vector3d(1.5e-3, 0, 0), 1e-3);
  EXPECT_NEAR(grid.clearance(corner, 1e-3), -0.5e-3, 1e-15);
}

}  // namespace
}  // namespace spume::coupling
