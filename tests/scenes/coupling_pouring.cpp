#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <map>

#include "coupling/scene_toml.h"
#include "coupling/simulation.h"
#include "coupling/vdb_liquid_sampler.h"

namespace spume::coupling {
namespace {

/// Books are kept in double: a few thousand sums of equal sign.
constexpr double kLedgerTolerance = 1e-12;

/// The aim of the pouring scene at every frame, relative to initial + poured.
constexpr double kVolumeTolerance = 0.01;

/// Deepest overlap with a wall that the one-sided contact spring leaves, in radii.
constexpr double kWallTolerance = 0.1;

/// Class changes of one bubble: liquid -> surface, and a few more where the surface around it is torn.
constexpr int kMaxClassChanges = 12;

/// The pouring scene at half resolution: the jet is four cells wide.
Scene coarsePouring() {
  return readScene(std::string(SPUME_SOURCE_DIR) + "/data/scenes/pouring.toml",
                   {{"domain.resolution", "32"}, {"liquid.markers_per_cell", "16"}});
}

/// One full coarse run, watched step by step; shared by the tests below.
class CoarsePouring : public testing::Test {
 protected:
  static constexpr int kFrames = 40;

  static void SetUpTestSuite() {
    Simulation simulation(coarsePouring());
    for (int frame = 0; frame < kFrames; ++frame) {
      simulation.advanceFrame([&](const StepReport& step) { watch(simulation, step); });
    }
  }

  static void watch(const Simulation& simulation, const StepReport& step) {
    ++steps_;
    births_ += step.births;
    worstImbalance_ =
        std::max(worstImbalance_, std::abs(step.gas.imbalance()) / (step.gas.entered() + 1e-30));
    const double held = step.liquid.liquidVolume - step.immersedGas;
    const double target = step.liquid.targetVolume - step.immersedGas;
    worstVolume_ = std::max(worstVolume_, std::abs(held - target) / target);
    for (const Event& event : step.events) {
      if (event.kind == Event::Kind::classChange) ++changes_[event.id];
      if (event.kind == Event::Kind::burst && event.from == foam::BubbleClass::liquid) ++burstUnderWater_;
      if (event.kind == Event::Kind::birth && event.cause != BirthCause::marker &&
          event.cause != BirthCause::pocket)
        ++otherBirths_;
    }
    watchWalls(simulation);
  }

  static void watchWalls(const Simulation& simulation) {
    const foam::BubbleStore& bubbles = simulation.bubbles();
    if (bubbles.size() == 0) return;
    const VdbLiquidSampler sampler(simulation.liquid(), simulation.solids());
    Eigen::VectorXd psi(bubbles.size());
    sampler.psi(bubbles.positions(), psi);
    for (std::size_t b = 0; b < bubbles.size(); ++b)
      deepest_ = std::max(deepest_, (bubbles.radius[b] - psi[b]) / bubbles.radius[b]);
  }

  static inline int steps_ = 0, burstUnderWater_ = 0, otherBirths_ = 0;
  static inline std::size_t births_ = 0;
  static inline double worstImbalance_ = 0, worstVolume_ = 0, deepest_ = 0;
  static inline std::map<std::uint64_t, int> changes_;
};

TEST_F(CoarsePouring, JetEntrainsBubblesFromMarkersAndPocketsOnly) {
  EXPECT_GT(births_, 100u);
  EXPECT_EQ(otherBirths_, 0);
}

TEST_F(CoarsePouring, GasLedgerClosesEveryStep) { EXPECT_LT(worstImbalance_, kLedgerTolerance); }

TEST_F(CoarsePouring, LiquidVolumeStaysAtInitialPlusPoured) { EXPECT_LT(worstVolume_, kVolumeTolerance); }

TEST_F(CoarsePouring, NoBubbleEntersAWall) { EXPECT_LT(deepest_, kWallTolerance); }

TEST_F(CoarsePouring, NoBubbleBurstsUnderWater) { EXPECT_EQ(burstUnderWater_, 0); }

TEST_F(CoarsePouring, ClassesDoNotFlicker) {
  for (const auto& [id, count] : changes_) EXPECT_LE(count, kMaxClassChanges) << "bubble " << id;
}

void expectSameField(const fluid::DenseField<float>& a, const fluid::DenseField<float>& b) {
  ASSERT_EQ(a.size(), b.size());
  const Eigen::Vector3i& n = a.size();
  for (int i = 0; i < n.x(); ++i)
    for (int j = 0; j < n.y(); ++j)
      for (int k = 0; k < n.z(); ++k) ASSERT_EQ(a(i, j, k), b(i, j, k)) << i << ' ' << j << ' ' << k;
}

void expectSameBits(const SimulationState& a, const SimulationState& b) {
  expectSameField(a.liquid.phi, b.liquid.phi);
  for (int axis = 0; axis < 3; ++axis) expectSameField(a.liquid.velocity[axis], b.liquid.velocity[axis]);
  EXPECT_EQ(a.liquid.positive.x, b.liquid.positive.x);
  EXPECT_EQ(a.liquid.positive.gas, b.liquid.positive.gas);
  EXPECT_EQ(a.liquid.negative.y, b.liquid.negative.y);
  EXPECT_EQ(a.bubbles.id, b.bubbles.id);
  EXPECT_EQ(a.bubbles.position, b.bubbles.position);
  EXPECT_EQ(a.bubbles.velocity, b.bubbles.velocity);
  EXPECT_EQ(a.bubbles.radius, b.bubbles.radius);
  EXPECT_EQ(a.gas.inReservoirs, b.gas.inReservoirs);
}

SimulationState runOn(int threads, int frames) {
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
  Simulation simulation(coarsePouring());
  for (int frame = 0; frame < frames; ++frame) simulation.advanceFrame();
  return simulation.state();
}

/// Long enough for the jet to reach the pool and to entrain.
constexpr int kDeterminismFrames = 12;

TEST(Determinism, OneAndFourThreadsGiveTheSameBits) {
  expectSameBits(runOn(1, kDeterminismFrames), runOn(4, kDeterminismFrames));
}

TEST(Determinism, ResumedRunEqualsUninterruptedRun) {
  Simulation whole(coarsePouring());
  for (int frame = 0; frame < kDeterminismFrames / 2; ++frame) whole.advanceFrame();
  Simulation resumed(coarsePouring(), whole.state());
  for (int frame = kDeterminismFrames / 2; frame < kDeterminismFrames; ++frame) {
    whole.advanceFrame();
    resumed.advanceFrame();
  }
  expectSameBits(whole.state(), resumed.state());
}

}  // namespace
}  // namespace spume::coupling
