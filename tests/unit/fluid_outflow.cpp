#include <gtest/gtest.h>

#include <cmath>

#include "fluid/errors.h"
#include "fluid/liquid_solver.h"
#include "tests/fluid_scenery.h"

namespace spume::fluid {
namespace {

using namespace testing;

constexpr double kDt = 0.01;  // [s]

/// A box of 0.16 m, open at the top, filled 0.08 m deep.
LiquidSolver halfFullTank(const Outflow& outflow) {
  LiquidSetup setup;
  setup.grid = boxGrid(16);
  setup.outflows = {outflow};
  return LiquidSolver(FluidParams{}, setup, [](const Eigen::Vector3d& x) { return x.y() - 0.08; });
}

Outflow ball(const Eigen::Vector3d& centre, double radius) {
  Outflow outflow;
  outflow.name = "drain";
  outflow.sdf = [=](const Eigen::Vector3d& x) { return (x - centre).norm() - radius; };
  outflow.rate = [](double) { return 1.0; };
  return outflow;
}

TEST(Outflow, APumpTakesItsRateAndTheSurfaceFalls) {
  constexpr double kRate = 2e-4;  // [m^3/s]: the surface falls at 8 mm/s
  Outflow pump = ball({0.08, 0.02, 0.08}, 0.02);
  pump.free = false;
  pump.rate = [](double t) { return t <= 0.205 ? kRate : 0; };
  LiquidSolver liquid = halfFullTank(pump);
  const double before = liquid.liquidVolume();
  double drained = 0;
  for (int n = 0; n < 30; ++n) drained += liquid.step(kDt).drained;
  EXPECT_NEAR(drained, 0.2 * kRate, 1e-9 * kRate);  // sums of floats times their cells
  // What the books lose the grid loses: volume control leaves no more than a hundredth of what was taken.
  EXPECT_NEAR(before - liquid.liquidVolume(), drained, 0.01 * drained);
}

TEST(Outflow, APumpInTheAirTakesNothing) {
  Outflow pump = ball({0.08, 0.13, 0.08}, 0.02);
  pump.free = false;
  LiquidSolver liquid = halfFullTank(pump);
  EXPECT_EQ(liquid.step(kDt).drained, 0);
}

/// Half of a free region lies under the surface: that part is gone at once, and what flows in after it.
TEST(Outflow, AFreeRegionEmptiesItselfAndBooksWhatItTook) {
  LiquidSolver liquid = halfFullTank(ball({0.08, 0.08, 0.08}, 0.03));
  const double before = liquid.liquidVolume();
  double drained = liquid.step(kDt).drained;
  const double half = 2 * M_PI / 3 * std::pow(0.03, 3);
  EXPECT_NEAR(drained, half, 0.1 * half);  // a radius of three cells
  for (int n = 0; n < 20; ++n) drained += liquid.step(kDt).drained;
  EXPECT_GT(drained, 1.5 * half);
  EXPECT_NEAR(before - liquid.liquidVolume(), drained, 0.01 * before);
  EXPECT_GE(liquid.state().phi(8, 8, 8), 0);
}

TEST(Outflow, RegionsTooSmallForTheGridAreRefused) {
  EXPECT_THROW(halfFullTank(ball({0.08, 0.08, 0.08}, 0.004)), InvalidParameter);
  Outflow tiny = ball({0.08, 0.08, 0.08}, 0.001);
  tiny.free = false;
  EXPECT_THROW(halfFullTank(tiny), InvalidParameter);
}

}  // namespace
}  // namespace spume::fluid
