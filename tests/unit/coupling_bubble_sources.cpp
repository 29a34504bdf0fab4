// Sources of bubbles: numbers, gas, places, and that they depend on neither dt nor order.
#include <gtest/gtest.h>

#include <numbers>

#include "coupling/bubble_sources.h"
#include "coupling/still_liquid.h"
#include "foam/volume_correction.h"
#include "tests/support/coupling_shapes.h"

namespace spume::coupling {
namespace {

Scene sourceScene() {
  Scene scene;
  scene.domain.size = {0.1, 0.1, 0.1};
  scene.domain.resolution = 8;
  scene.stillPool = {true, 0.08};
  BubbleSourceSpec source;
  source.shape = test::boxShape({0.02, 0.01, 0.02}, {0.08, 0.05, 0.08});
  source.rate = 200;
  source.radius = {foam::RadiusLaw::uniform, 0, 0, 0, 0.5e-3, 1e-3};
  scene.bubbleSources = {source};
  return scene;
}

/// All bubbles blown until `end` in steps of dt.
std::vector<Blown> blownUntil(const Scene& scene, double end, double dt) {
  const BubbleSources sources(scene);
  const PoolSampler pool(scene);
  foam::BubbleStore bubbles;
  std::vector<SourceProgress> progress;
  std::vector<Blown> all;
  for (int step = 1; step * dt <= end * (1 + 1e-12); ++step)
    for (const Blown& blown : sources.step(step * dt, pool, bubbles, progress).bubbles) {
      bubbles.add(blown.bubble);
      all.push_back(blown);
    }
  return all;
}

TEST(BubbleSources, BlowTheirNumberAtAnyStep) {
  const Scene scene = sourceScene();
  const auto fine = blownUntil(scene, 1, 0.001), coarse = blownUntil(scene, 1, 0.05);
  EXPECT_NEAR(static_cast<double>(fine.size()), 200, 1);  // number n is due between n and n + 1
  ASSERT_EQ(fine.size(), coarse.size());
  for (std::size_t n = 0; n < fine.size(); ++n) {
    EXPECT_EQ(fine[n].bubble.radius, coarse[n].bubble.radius);
    EXPECT_EQ(fine[n].bubble.position, coarse[n].bubble.position);
  }
}

TEST(BubbleSources, BlowTheirGas) {
  Scene scene = sourceScene();
  scene.bubbleSources[0].measure = SourceMeasure::gas;
  scene.bubbleSources[0].gasRate.keys = {{0, 0}, {1, 1e-6}};  // half a cubic centimetre in the first second
  double gas = 0;
  for (const Blown& blown : blownUntil(scene, 1, 0.01))
    gas += 4 * std::numbers::pi / 3 * std::pow(blown.bubble.radius, 3);
  const double largest = 4 * std::numbers::pi / 3 * 1e-9;
  EXPECT_LE(gas, 0.5e-6);
  EXPECT_GT(gas, 0.5e-6 - largest);
}

TEST(BubbleSources, KeepToTheirHoursRegionAndRadii) {
  Scene scene = sourceScene();
  scene.bubbleSources[0].start = 0.5, scene.bubbleSources[0].stop = 0.75;
  EXPECT_TRUE(blownUntil(scene, 0.5, 0.01).empty());
  const auto all = blownUntil(scene, 2, 0.01);
  EXPECT_NEAR(static_cast<double>(all.size()), 50, 1);
  for (const Blown& blown : all) {
    EXPECT_TRUE((blown.bubble.position.array() >= Eigen::Array3d(0.02, 0.01, 0.02)).all());
    EXPECT_TRUE((blown.bubble.position.array() <= Eigen::Array3d(0.08, 0.05, 0.08)).all());
    EXPECT_GE(blown.bubble.radius, 0.5e-3);
    EXPECT_LE(blown.bubble.radius, 1e-3);
  }
}

TEST(BubbleSources, ChoosePlacesThatAreFree) {
  const auto all = blownUntil(sourceScene(), 1, 0.01);  // 1 % of the region: there is room for everyone
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_GE((all[i].bubble.position - all[j].bubble.position).norm(),
                all[i].bubble.radius + all[j].bubble.radius);
}

TEST(BubbleSources, StayDryWhereThereIsNoLiquidAndOutOfSolids) {
  Scene scene = sourceScene();
  scene.stillPool.level = 0.03;
  auto all = blownUntil(scene, 1, 0.01);
  EXPECT_FALSE(all.empty());
  for (const Blown& blown : all) EXPECT_LE(blown.bubble.position.y(), 0.03 - blown.bubble.radius);
  scene.stillPool.level = 0;
  EXPECT_TRUE(blownUntil(scene, 1, 0.01).empty());
  scene.bubbleSources[0].immersed = false;
  scene.solids = {test::solidOf("ball", test::ballShape({0.05, 0.03, 0.05}, 0.02))};
  all = blownUntil(scene, 1, 0.01);
  EXPECT_NEAR(static_cast<double>(all.size()), 200, 1);
  for (const Blown& blown : all)
    EXPECT_GE((blown.bubble.position - Eigen::Vector3d(0.05, 0.03, 0.05)).norm(), 0.02 + blown.bubble.radius);
}

/// Which bubbles find no place follows from their numbers alone; later liquid is not filled with those.
TEST(BubbleSources, CountWhatFindsNoPlaceAndItsGas) {
  Scene scene = sourceScene();
  scene.stillPool.level = 0.012;  // over 2 of the 40 mm of the region
  const BubbleSources sources(scene);
  std::vector<SourceProgress> progress;
  double placed = 0, unplaced = 0;
  std::uint64_t bubbles = 0;
  for (int step = 1; step <= 100; ++step) {
    const BlownStep blown = sources.step(step * 0.01, PoolSampler(scene), {}, progress);
    for (const Blown& one : blown.bubbles) placed += foam::ballVolume(one.bubble.radius);
    unplaced += blown.unplacedGas;
    bubbles += blown.bubbles.size();
  }
  EXPECT_GT(bubbles, 20u);
  EXPECT_GT(progress[0].unplaced, 20u);
  EXPECT_EQ(bubbles + progress[0].unplaced, progress[0].births);
  EXPECT_NEAR(placed + unplaced, progress[0].gas, 1e-12 * progress[0].gas);
  const std::vector<std::string> warnings = unplacedWarnings(scene, progress);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("bubble_source 0: " + std::to_string(progress[0].unplaced) + " of its "),
            std::string::npos)
      << warnings[0];
  scene.stillPool.level = 0.08;
  const std::uint64_t before = progress[0].births;
  EXPECT_LE(sources.step(1.01, PoolSampler(scene), {}, progress).bubbles.size(), 3u);  // 200 a second
  EXPECT_LE(progress[0].births, before + 3);
  progress[0].unplaced = 0;
  EXPECT_TRUE(unplacedWarnings(scene, progress).empty());
}

TEST(BubbleSources, DifferWithTheSeedAndFromEachOther) {
  Scene scene = sourceScene();
  scene.bubbleSources.push_back(scene.bubbleSources[0]);
  const auto first = blownUntil(scene, 0.1, 0.1);
  scene.seed = 2;
  const auto second = blownUntil(scene, 0.1, 0.1);
  EXPECT_NE(first.front().bubble.position, second.front().bubble.position);
  EXPECT_EQ(first.back().source, 1);
  EXPECT_NE(first.front().bubble.position, first.back().bubble.position);
}

}  // namespace
}  // namespace spume::coupling
