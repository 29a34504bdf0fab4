#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "foam/errors.h"
#include "foam/power_diagram.h"
#include "foam/weak_pairs.h"
#include "tests/support/foam_balls.h"
#include "tests/support/foam_relaxed.h"

namespace spume::foam::test {
namespace {

using Eigen::Vector3d;
using PairList = std::vector<std::pair<std::int32_t, std::int32_t>>;

PairList weakPairsOf(const Balls& balls, const std::vector<std::uint8_t>& surface, double range) {
  std::vector<WeakPair> weak;
  WeakPairs().find(balls.position, balls.radius, balls.id, surface, powerCellsOf(balls), range, weak);
  PairList pairs;
  for (const WeakPair& pair : weak) {
    EXPECT_EQ(pair.distance, (balls.position[pair.i] - balls.position[pair.j]).norm());
    pairs.emplace_back(pair.i, pair.j);
  }
  return pairs;
}

/// From CGAL's alpha complex: neighbours in the diagram at alpha = (range/2)^2 without those at alpha = 0.
PairList reference(const Balls& balls, const std::vector<std::uint8_t>& surface, double range) {
  const PairList contacts = alphaComplexEdges(balls.position, balls.radius, balls.id, 0);
  PairList pairs;
  for (const auto& [i, j] : alphaComplexEdges(balls.position, balls.radius, balls.id, range * range / 4))
    if (surface[i] && surface[j] && (balls.position[i] - balls.position[j]).norm() <= range &&
        !std::binary_search(contacts.begin(), contacts.end(), std::make_pair(i, j)))
      pairs.emplace_back(i, j);
  return pairs;
}

std::vector<std::uint8_t> everyBubble(const Balls& balls) {
  return std::vector<std::uint8_t>(balls.size(), 1);
}

Balls raft(int count, double sigma, double coverage, std::uint64_t seed) {
  Balls balls = randomFoam(count, sigma, 4, 1, seed);
  double area = 0, side = 0;
  for (double r : balls.radius) area += std::numbers::pi * r * r;
  for (const auto& x : balls.position) side = std::max(side, x.maxCoeff());
  for (std::size_t i = 0; i < balls.size(); ++i) {
    balls.position[i] *= std::sqrt(area / coverage) / side;
    balls.position[i].y() = -.5 * balls.radius[i];
  }
  return balls;
}

TEST(WeakPairs, TwoApartAttractWithinTheRange) {
  Balls balls;
  balls.add({0, 0, 0}, 1), balls.add({5, 0, 0}, .5);
  EXPECT_EQ(weakPairsOf(balls, {1, 1}, 5.1), (PairList{{0, 1}}));
  EXPECT_TRUE(weakPairsOf(balls, {1, 1}, 4.9).empty());
  EXPECT_TRUE(weakPairsOf(balls, {1, 0}, 5.1).empty());
}

TEST(WeakPairs, ContactsAreLeftOut) {
  Balls balls;
  balls.add({0, 0, 0}, 1), balls.add({1.5, 0, 0}, 1), balls.add({4, 0, 0}, 1);
  EXPECT_EQ(weakPairsOf(balls, {1, 1, 1}, 10), (PairList{{1, 2}}));
}

/// The middle one's plane covers the face of the outer two, be it at the surface or not.
TEST(WeakPairs, AnyBubbleBetweenTwoBlocksThem) {
  Balls balls;
  balls.add({0, 0, 0}, 1), balls.add({8, 0, 0}, 1), balls.add({4, 0, 0}, .5);
  EXPECT_TRUE(weakPairsOf(balls, {1, 1, 0}, 9).empty());
  EXPECT_EQ(weakPairsOf(balls, {1, 1, 1}, 9), (PairList{{0, 2}, {1, 2}}));
}

TEST(WeakPairs, AreTheEdgesOfTheRegularTriangulationOnRafts) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed)
    for (double coverage : {.1, .5, .9})
      for (double range : {4., 12., 40.}) {
        const Balls balls = raft(150, .4, coverage, seed);
        EXPECT_EQ(weakPairsOf(balls, everyBubble(balls), range), reference(balls, everyBubble(balls), range))
            << "seed " << seed << " coverage " << coverage << " range " << range;
      }
}

TEST(WeakPairs, AreTheEdgesOfTheRegularTriangulationInFoams) {
  for (double fraction : {.05, .3, 1.}) {
    const Balls balls = randomFoam(400, .5, 4, fraction, 9);
    std::vector<std::uint8_t> surface = everyBubble(balls);
    EXPECT_EQ(weakPairsOf(balls, surface, 10), reference(balls, surface, 10));
    for (std::size_t i = 0; i < surface.size(); i += 2) surface[i] = 0;
    EXPECT_EQ(weakPairsOf(balls, surface, 10), reference(balls, surface, 10));
  }
  const Balls dense = relaxedFoam(500, .4, 3);
  EXPECT_EQ(weakPairsOf(dense, everyBubble(dense), 5e-3), reference(dense, everyBubble(dense), 5e-3));
}

TEST(WeakPairs, LatticesAndCoincidentBubblesAreSafe) {
  Balls balls;
  for (int i = 0; i < 36; ++i) balls.add({3.0 * (i % 6), 0, 3.0 * (i / 6)}, 1);
  EXPECT_EQ(weakPairsOf(balls, everyBubble(balls), 5), reference(balls, everyBubble(balls), 5));
  balls.add(balls.position[0], 1), balls.add(balls.position[1], .5), balls.add(balls.position[2], 1.5);
  EXPECT_EQ(weakPairsOf(balls, everyBubble(balls), 5), reference(balls, everyBubble(balls), 5));
}

/// The grid of sites is far too large for a table then.
TEST(WeakPairs, ABubbleFarOffChangesNothing) {
  Balls balls = raft(150, .4, .5, 5);
  const PairList alone = weakPairsOf(balls, everyBubble(balls), 12);
  balls.add({1e6, -2e6, 3e6}, 1);
  EXPECT_FALSE(alone.empty());
  EXPECT_EQ(weakPairsOf(balls, everyBubble(balls), 12), alone);
}

TEST(WeakPairs, ThreadsDoNotChangeTheList) {
  const Balls balls = raft(800, .4, .5, 17);
  const PairList alone = [&] {
    tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
    return weakPairsOf(balls, everyBubble(balls), 10);
  }();
  EXPECT_EQ(weakPairsOf(balls, everyBubble(balls), 10), alone);
}

TEST(WeakPairs, RejectsARangeThatIsNone) {
  std::vector<WeakPair> weak;
  EXPECT_THROW(WeakPairs().find({}, {}, {}, {}, {}, 0, weak), InvalidParameter);
  EXPECT_THROW(WeakPairs().find({}, {}, {}, {1}, {}, 1, weak), InvalidParameter);
}

}  // namespace
}  // namespace spume::foam::test
