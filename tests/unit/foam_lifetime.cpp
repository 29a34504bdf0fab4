// Bursting as a hazard, coalescence and unsupported clusters.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "foam/counter_random.h"
#include "foam/lifetime.h"
#include "tests/foam_fixtures.h"

namespace spume::foam::test {
namespace {

/// n bubbles aloft that touch nothing, and the topology that says so.
struct OpenBubbles {
  BubbleStore bubbles;
  FoamTopology topology;
  std::vector<std::uint8_t> supported;

  OpenBubbles(std::size_t n, double radius) : supported(n, 1) {
    for (std::size_t i = 0; i < n; ++i)
      bubbles.add(bubbleAt({static_cast<double>(i), 1, 0}, radius, {0, 0, 0}, BubbleClass::air));
    topology.freeArea.assign(n, 4 * std::numbers::pi * radius * radius);
    topology.volume = bubbles.gas;
    topology.hidden.assign(n, 0);
  }
  /// Far from any solid.
  Eigen::VectorXd psi() const {
    return Eigen::VectorXd::Constant(static_cast<Eigen::Index>(bubbles.size()), 1.0);
  }
};

/// Lives [s] of n bubbles, stepped by dt(step).
template <typename Step>
std::vector<double> lives(const FoamParams& params, std::size_t n, double radius, const Step& dt) {
  OpenBubbles open(n, radius);
  std::vector<double> found;
  for (int step = 0; found.size() < n && step < 100000; ++step) {
    std::vector<std::uint8_t> gone(open.bubbles.size(), 0);
    for (const EndedLife& life :
         endLives(params, open.topology, open.supported, open.psi(), dt(step), open.bubbles))
      gone[life.index] = 1, found.push_back(life.age);
    open.bubbles.remove(gone);
  }
  std::sort(found.begin(), found.end());
  return found;
}

/// Kolmogorov-Smirnov distance from F(t) = 1 - exp(-ln 2 (t / median)^shape).
double distanceFromWeibull(const std::vector<double>& sorted, double median, double shape) {
  double worst = 0;
  for (std::size_t k = 0; k < sorted.size(); ++k) {
    const double exact = -std::expm1(-std::numbers::ln2 * std::pow(sorted[k] / median, shape));
    const auto n = static_cast<double>(sorted.size());
    worst = std::max({worst, std::abs(exact - static_cast<double>(k) / n),
                      std::abs(exact - (static_cast<double>(k) + 1) / n)});
  }
  return worst;
}

TEST(Lifetime, FollowsRayleighAndWeibullForEveryStep) {
  constexpr std::size_t kCount = 4000;
  const double critical = 1.63 / std::sqrt(static_cast<double>(kCount));  // Kolmogorov-Smirnov at p = 0.01
  FoamParams params;
  params.burstMedianLife = 0.4;
  const auto mixed = [](int step) { return step % 3 == 0 ? 0.001 : step % 3 == 1 ? 0.02 : 0.1; };
  for (const double shape : {2.0, 4.0 / 3}) {
    params.burstShape = shape;
    // Larger bubbles live shorter: the hazard grows with r, so the median with r^(-1/shape).
    const double radius = 2e-3, median = 0.4 * std::pow(2.0, -1 / shape);
    const auto reference = lives(params, kCount, radius, [](int) { return 0.005; });
    EXPECT_LE(distanceFromWeibull(reference, median, shape), critical);
    const auto same = [&](const std::vector<double>& other) {
      for (std::size_t k = 0; k < kCount; k += 97) EXPECT_NEAR(other[k], reference[k], 1e-9);
    };
    same(lives(params, kCount, radius, [](int) { return 0.001; }));
    same(lives(params, kCount, radius, [](int) { return 0.02; }));
    same(lives(params, kCount, radius, mixed));
  }
}

TEST(Lifetime, ClockRunsSlowerNearWallsIfAsked) {
  FoamParams params;
  EXPECT_EQ(burstClockSpeed(params, 0, 1e-3), 1);
  params.burstWallFactor = 0.25, params.burstWallDistance = 5e-3;
  EXPECT_EQ(burstClockSpeed(params, 1e-3, 1e-3), 0.25);
  EXPECT_EQ(burstClockSpeed(params, -1e-3, 1e-3), 0.25);
  EXPECT_DOUBLE_EQ(burstClockSpeed(params, 3e-3, 1e-3), 0.625);
  EXPECT_EQ(burstClockSpeed(params, 5e-3, 1e-3), 1);
  // At the wall everything takes four times as long, whatever the shape of the hazard.
  OpenBubbles open(1, 1e-3), wall(1, 1e-3);
  const Eigen::VectorXd touching = Eigen::VectorXd::Constant(1, 1e-3);
  const auto advance = [&](OpenBubbles& one, const Eigen::VectorXd& psi, double dt) {
    return endLives(params, one.topology, one.supported, psi, dt, one.bubbles);
  };
  const auto inOpen = advance(open, open.psi(), 100), atWall = advance(wall, touching, 100);
  ASSERT_EQ(inOpen.size(), 1u);
  ASSERT_EQ(atWall.size(), 1u);
  EXPECT_NEAR(atWall[0].age, 4 * inOpen[0].age, 1e-12);
}

TEST(Lifetime, ClockStandsStillUnderWater) {
  OpenBubbles open(100, 1e-3);
  FoamParams params;
  params.burstMedianLife = 1e-3;
  std::fill(open.bubbles.type.begin(), open.bubbles.type.end(), BubbleClass::liquid);
  for (int step = 0; step < 100; ++step)
    EXPECT_TRUE(endLives(params, open.topology, open.supported, open.psi(), 0.1, open.bubbles).empty());
  EXPECT_EQ(open.bubbles.exposure[0], 0);
  EXPECT_NEAR(open.bubbles.age[0], 10, 1e-12);
}

TEST(Lifetime, ExposureAndTimeAreInverse) {
  const FoamParams params;
  for (const double time : {0.0, 1e-6, 0.3, 1e6})
    EXPECT_NEAR(timeOfExposure(params, 1e-9, burstExposure(params, 1e-9, time)), time, 1e-12 * time);
}

TEST(Lifetime, SmallExposuresAndLongLivesStayFinite) {
  OpenBubbles open(2, 1e-3);
  open.bubbles.age = {0, 1e9}, open.bubbles.exposure = {0, 1e12};
  const auto ended = endLives(FoamParams(), open.topology, open.supported, open.psi(), 0.01, open.bubbles);
  ASSERT_EQ(ended.size(), 1u);
  EXPECT_EQ(ended[0].index, 1u);
  EXPECT_TRUE(std::isfinite(ended[0].age));
}

/// A row of bubbles 0 - 1 - 2 - ...: films grow along the row.
OpenBubbles row(std::size_t n) {
  OpenBubbles open(n, 1e-3);
  for (std::int32_t i = 0; i + 1 < static_cast<std::int32_t>(n); ++i)
    open.topology.films.push_back({i, i + 1, 1e-3, 5e-4, 1e-7 * (i + 1)});
  return open;
}

TEST(Lifetime, AnEnclosedBubbleLeavesItsGasToTheLargestFilm) {
  OpenBubbles open = row(3);
  open.topology.freeArea[1] = 0;
  open.bubbles.exposure[1] = 1e3;
  const auto ended = endLives(FoamParams(), open.topology, open.supported, open.psi(), 0.001, open.bubbles);
  ASSERT_EQ(ended.size(), 1u);
  EXPECT_EQ(ended[0].index, 1u);
  EXPECT_EQ(ended[0].heir, 2);
}

TEST(Lifetime, EnclosedBubblesThatInheritFromEachOtherDoNotWaitForEver) {
  OpenBubbles open = row(2);
  std::fill(open.topology.freeArea.begin(), open.topology.freeArea.end(), 0);
  std::fill(open.bubbles.exposure.begin(), open.bubbles.exposure.end(), 1e3);
  const auto ended = endLives(FoamParams(), open.topology, open.supported, open.psi(), 0.001, open.bubbles);
  ASSERT_EQ(ended.size(), 1u);
  EXPECT_EQ(ended[0].heir, 1);
}

TEST(Lifetime, CoalescenceKeepsGasCentroidAndMomentum) {
  constexpr double kRound = 1e-12;  // accuracy, T4
  OpenBubbles open = row(2);
  BubbleStore& b = open.bubbles;
  b.gas = {1e-9, 3e-9}, b.velocity = {{1, 0, 0}, {0, -2, 0}};
  const std::vector<double> mass{2e-6, 5e-6};
  const Eigen::Vector3d centroid = (1e-9 * b.position[0] + 3e-9 * b.position[1]) / 4e-9;
  const Eigen::Vector3d momentum = 2e-6 * b.velocity[0] + 5e-6 * b.velocity[1];
  b.wetness = {0.2, 0.6};
  const double ball = std::pow(b.radius[1], 3) / b.gas[1];
  coalesce(0, 1, mass, b);
  EXPECT_NEAR(b.gas[1], 4e-9, 4e-9 * kRound);
  EXPECT_LE((b.position[1] - centroid).norm(), kRound);
  EXPECT_LE(((2e-6 + 5e-6) * b.velocity[1] - momentum).norm(), kRound * momentum.norm());
  EXPECT_NEAR(std::pow(b.radius[1], 3) / b.gas[1], ball, ball * kRound);
  EXPECT_NEAR(b.wetness[1], (0.2 * 1 + 0.6 * 3) / 4, kRound);  // of the liquid between them, by gas
}

TEST(Lifetime, AirClustersWithoutSupportEndWithinTheirTime) {
  OpenBubbles open = row(6);  // 0-1-2 hang on to a surface bubble, 3-4-5 on nothing
  open.topology.films.erase(open.topology.films.begin() + 2);
  open.bubbles.type[0] = BubbleClass::surface;
  const Eigen::VectorXd psi = Eigen::VectorXd::Constant(6, 1.0);
  open.supported = supportedBubbles(open.topology, psi, open.bubbles);
  EXPECT_EQ(open.supported, (std::vector<std::uint8_t>{1, 1, 1, 0, 0, 0}));
  FoamParams params;
  params.burstMedianLife = 1e9;
  std::vector<std::size_t> ended;
  for (int step = 0; step < 20; ++step)
    for (const EndedLife& life :
         endLives(params, open.topology, open.supported, open.psi(), 0.005, open.bubbles))
      ended.push_back(life.index);
  std::sort(ended.begin(), ended.end());
  ended.erase(std::unique(ended.begin(), ended.end()), ended.end());
  EXPECT_EQ(ended, (std::vector<std::size_t>{3, 4, 5}));
}

TEST(Lifetime, SupportIsWhatAFloodFromTheHeldReaches) {
  constexpr std::int32_t kCount = 40000;
  OpenBubbles open(kCount, 1e-3);
  FoamTopology& topology = open.topology;
  std::vector<std::vector<std::int32_t>> met(kCount);
  for (std::int32_t i = 0; i < kCount; ++i) {
    CounterRandom random(3, static_cast<std::uint64_t>(i), 0);
    if (random.uniform() < 0.002) open.bubbles.type[i] = BubbleClass::surface;
    topology.hidden[i] = random.uniform() < 0.1;
  }
  for (std::int32_t i = 0; i < kCount; ++i) {
    CounterRandom random(3, static_cast<std::uint64_t>(i), 1);
    const std::int32_t links = random.uniform() < 0.6 ? 2 : 0;
    for (std::int32_t k = 0; k < links; ++k) {
      const auto j = static_cast<std::int32_t>(i + 1 + 30 * random.uniform());
      if (j >= kCount) continue;
      const bool swallows = topology.hidden[i] || topology.hidden[j], hasFilm = !swallows;
      topology.overlaps.push_back({i, j, 1e-3, hasFilm ? 0 : -1});
      if (hasFilm) topology.films.push_back({i, j, 1e-3, 0, 0});
      if (swallows || hasFilm) met[i].push_back(j), met[j].push_back(i);
    }
  }
  std::vector<std::uint8_t> reached(kCount, 0);
  std::vector<std::int32_t> ends;
  const auto reach = [&](std::int32_t i) {
    if (!std::exchange(reached[i], 1)) ends.push_back(i);
  };
  for (std::int32_t i = 0; i < kCount; ++i)
    if (open.bubbles.type[i] == BubbleClass::surface) reach(i);
  while (!ends.empty()) {
    const std::int32_t i = ends.back();
    ends.pop_back();
    std::for_each(met[i].begin(), met[i].end(), reach);
  }
  const auto supported = std::count(reached.begin(), reached.end(), 1);
  EXPECT_GT(supported, kCount / 10);
  EXPECT_LT(supported, kCount * 9 / 10);
  EXPECT_EQ(supportedBubbles(topology, open.psi(), open.bubbles), reached);
}

TEST(Lifetime, WithoutSupportTheClockRunsOutSteadily) {
  // A share dt / kUnsupportedLife of the threshold a step, whatever it is: all end together.
  constexpr double kStep = kUnsupportedLife / 20;
  constexpr double kOwnClock = 1e-7;  // what bursting by age adds in 0.1 s to some 1e7 s of exposure
  OpenBubbles open(50, 1e-3);
  std::fill(open.supported.begin(), open.supported.end(), 0);
  FoamParams params;
  params.burstMedianLife = 1e9;
  std::size_t ended = 0;
  for (int step = 1; step <= 19; ++step)
    ended += endLives(params, open.topology, open.supported, open.psi(), kStep, open.bubbles).size();
  EXPECT_EQ(ended, 0u);
  for (std::size_t i = 0; i < 50; ++i) {
    const double threshold = burstThreshold(params.seed, open.bubbles.id[i]);
    EXPECT_NEAR(open.bubbles.exposure[i], 0.95 * threshold, kOwnClock * threshold) << i;
  }
  // One more would be the last but for the round-off of twenty sums.
  endLives(params, open.topology, open.supported, open.psi(), kStep, open.bubbles);
  EXPECT_GE(endLives(params, open.topology, open.supported, open.psi(), kStep, open.bubbles).size(), 50u);
}

}  // namespace
}  // namespace spume::foam::test
