#include <gtest/gtest.h>

#include <cmath>

#include "fluid/liquid_solver.h"
#include "fluid/volume_control.h"
#include "tests/fluid_scenery.h"

namespace spume::fluid {
namespace {

using namespace testing;

constexpr double kDt = 0.005;
constexpr double kRoundOff = 1e-12;  // of sums over some 10^4 cells, relative
constexpr double kFloat = 1e-6;      // of sources, which are float

struct Stage {
  GridSpec grid = boxGrid(32);
  SolidBoundary boundary = buildSolidBoundary(grid, DomainWalls{}, {}, 0);
  MacVelocity velocity{grid.cells};
  FluidParams params;
  VolumeControl control{grid, params};

  LiquidBodies bodies(const std::function<double(const Eigen::Vector3d&)>& phi) const {
    LiquidBodies found;
    found.find(grid, sampleCells(grid, phi), boundary);
    return found;
  }
  void update(const LiquidBodies& now, const std::vector<PouredVolume>& poured = {},
              const ImmersedGas& gas = {}) {
    control.update(now, velocity, kDt, poured, gas);
  }
  /// Volume the sources create in kDt [m^3].
  double created(const LiquidBodies& now) {
    DenseField<float> source(grid.cells, 0);
    control.addSource(now, boundary, kDt, source);
    double sum = 0;
    for (int i = 0; i < 32; ++i)
      for (int j = 0; j < 32; ++j)
        for (int k = 0; k < 32; ++k) sum += source(i, j, k);
    return sum * grid.cellVolume() * kDt;
  }
};

double pool(const Eigen::Vector3d& x, double height) { return x.y() - height; }
double drop(const Eigen::Vector3d& x, const Eigen::Vector3d& centre, double radius) {
  return (x - centre).norm() - radius;
}

TEST(VolumeControl, LeavesAPoolAtItsTargetAlone) {
  Stage stage;
  const LiquidBodies still = stage.bodies([](const auto& x) { return pool(x, 0.0517); });
  stage.control.start(still);
  for (int n = 0; n < 3; ++n) {
    stage.update(still);
    EXPECT_EQ(stage.created(still), 0);
  }
  EXPECT_EQ(stage.control.targetVolume(), still.bodies[0].volume);
}

TEST(VolumeControl, RemovesAnErrorWithItsRelaxationTime) {
  Stage stage;
  for (double height : {0.98 * 0.0517, 1.02 * 0.0517}) {
    stage.control.start(stage.bodies([](const auto& x) { return pool(x, 0.0517); }));
    const LiquidBodies now = stage.bodies([&](const auto& x) { return pool(x, height); });
    stage.update(now);
    const double error = 0.16 * 0.16 * (0.0517 - height);
    EXPECT_NEAR(stage.created(now) / error, 1 - std::exp(-kDt / stage.params.volumeControlTime), 1e-5);
  }
}

TEST(VolumeControl, LearnsASteadyLossUntilNoErrorIsLeft) {
  // Proportional control alone would leave the error lost/x, x = 1 - e^(-dt/tau) = 0.63, for ever. With the
  // learning it fades as n (1 - x/2)^n: 40 sub-steps leave 40 0.68^39 < 2e-5 of it. Float phi resolves 1e-4.
  constexpr double kLeft = 1e-3;
  constexpr double kLost = 1e-7, kArea = 0.16 * 0.16;  // [m^3] a sub-step
  Stage stage;
  double height = 0.0517;
  stage.control.start(stage.bodies([&](const auto& x) { return pool(x, height); }));
  const double target = stage.control.targetVolume();
  double error = 0;
  for (int n = 0; n < 40; ++n) {
    height -= kLost / kArea;
    const LiquidBodies now = stage.bodies([&](const auto& x) { return pool(x, height); });
    stage.update(now);
    error = target - now.bodies[0].volume;
    height += stage.created(now) / kArea;
  }
  EXPECT_NEAR(error, 0, kLeft * kLost);
  EXPECT_NEAR(stage.control.ledger().loss[0] * kDt, kLost, kLeft * kLost);
}

TEST(VolumeControl, KeepsTheSumWhenBodiesMergeSplitAndVanish) {
  Stage stage;
  const auto apart = [](const Eigen::Vector3d& x) {
    return std::min({pool(x, 0.0517), drop(x, {0.05, 0.1, 0.08}, 0.02), drop(x, {0.13, 0.12, 0.13}, 0.007)});
  };
  const auto landed = [](const Eigen::Vector3d& x) {
    return std::min(pool(x, 0.0517), drop(x, {0.05, 0.06, 0.08}, 0.02));
  };
  const LiquidBodies before = stage.bodies(apart), after = stage.bodies(landed);
  ASSERT_EQ(before.bodies.size(), 3u);
  ASSERT_EQ(after.bodies.size(), 1u);
  stage.control.start(before);
  const double total = stage.control.ledger().total();
  stage.update(after);
  ASSERT_EQ(stage.control.ledger().target.size(), 1u);
  EXPECT_NEAR(stage.control.ledger().target[0], total, kRoundOff * total);
  stage.update(before);  // splits again: all three have the same relative error
  EXPECT_NEAR(stage.control.ledger().total(), total, kRoundOff * total);
  for (std::size_t n = 0; n < 3; ++n)
    EXPECT_NEAR(stage.control.ledger().target[n], before.bodies[n].volume, kRoundOff * total);
}

TEST(VolumeControl, ADropsErrorStaysItsOwnWhileItFlies) {
  Stage stage;
  const auto scene = [](double x0, double radius) {
    return [=](const Eigen::Vector3d& x) {
      return std::min(pool(x, 0.0517), drop(x, {x0, 0.11, 0.08}, radius));
    };
  };
  const LiquidBodies before = stage.bodies(scene(0.05, 0.006));
  stage.control.start(before);
  stage.velocity[0].fill(static_cast<float>(0.015 / kDt));  // further than its own width in one step
  const LiquidBodies after = stage.bodies(scene(0.065, 0.0055));
  ASSERT_EQ(after.bodies.size(), 2u);
  stage.update(after);
  for (int n : {0, 1}) EXPECT_EQ(stage.control.ledger().target[n], before.bodies[n].volume);
}

TEST(VolumeControl, BooksPouredWaterAndTheGasOfBubbles) {
  Stage stage;
  const LiquidBodies still = stage.bodies([](const auto& x) { return pool(x, 0.0517); });
  stage.control.start(still);
  stage.update(still, {{2e-6, {5, 5, 5}}}, {{{0.08, 0.02, 0.08}, {0.08, 0.15, 0.08}}, {3e-6, 4e-6}});
  EXPECT_NEAR(stage.control.ledger().total() - still.bodies[0].volume, 2e-6, 1e-15);
  EXPECT_NEAR(stage.control.targetVolume() - still.bodies[0].volume, 5e-6,
              1e-15);  // the second one is in the air
  const double share = 1 - std::exp(-kDt / stage.params.volumeControlTime);
  EXPECT_NEAR(stage.created(still) / (5e-6 * share), 1, 10 * kFloat);
}

TEST(VolumeControl, WaitsForABodyWhenTheLastOneVanished) {
  Stage stage;
  const LiquidBodies some = stage.bodies([](const auto& x) { return drop(x, {0.08, 0.1, 0.08}, 0.02); });
  const LiquidBodies none = stage.bodies([](const auto&) { return 1.0; });
  stage.control.start(some);
  const double total = stage.control.ledger().total();
  stage.update(none);
  EXPECT_EQ(stage.control.ledger().unassigned, total);
  stage.update(some);
  EXPECT_NEAR(stage.control.ledger().target.at(0), total, kRoundOff * total);
}

TEST(VolumeControl, LimitsWhatATinyDropIsTold) {
  Stage stage;
  stage.control.start(stage.bodies([](const auto& x) { return drop(x, {0.0825, 0.1025, 0.0825}, 0.02); }));
  const LiquidBodies tiny = stage.bodies([](const auto& x) {
    return drop(x, {0.0825, 0.1025, 0.0825}, 0.004);
  });
  ASSERT_EQ(tiny.bodies.size(), 1u);
  stage.update(tiny);
  const double share = 1 - std::exp(-kDt / stage.params.volumeControlTime);
  EXPECT_LE(stage.created(tiny), 0.5 * share * tiny.bodies[0].room * (1 + kFloat));
}

TEST(VolumeControl, BooksWhatFlowsOutThroughAnOpenSide) {
  Stage stage;
  stage.boundary = buildSolidBoundary(stage.grid, {{true, false, true, false, true, true}}, {}, 0);
  const auto surface = [](const Eigen::Vector3d& x) { return pool(x, 0.0517); };
  const LiquidBodies still = stage.bodies(surface);
  stage.control.start(still);
  stage.velocity[0].fill(0.25f);
  const double drained =
      stage.control.bookOutflow(sampleCells(stage.grid, surface), stage.boundary, stage.velocity, kDt);
  EXPECT_NEAR(drained / (0.25 * kDt * 0.16 * 0.05), 1, 0.05);  // wet cells: to whole rows, 10 of them
  EXPECT_NEAR(stage.control.ledger().total(), still.bodies[0].volume - drained, 1e-15);
}

}  // namespace
}  // namespace spume::fluid
