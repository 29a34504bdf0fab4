// Clusters of equal dry bubbles against the exact table (accuracy, 4.1: G1, G2).
#include <gtest/gtest.h>

#include "tests/foam_fixtures.h"

namespace spume::foam::test {
namespace {

/// Weightless dry foam; strong damping, because only the state at rest is asked for.
FoamParams dryParams() {
  FoamParams params = makePreset(Preset::paper);
  params.gravity.setZero();
  params.wetness = params.wetnessAloft = 0;
  params.contactDamping = 1;
  params.bursting = false;
  params.solverTolerance = 1e-10;
  return params;
}

/// Starts `radii.size()` bubbles near the corners of a tetrahedron, off by a seeded tenth of a radius, and
/// lets them rest.
BubbleStore relaxedCluster(const std::vector<double>& radii, std::uint64_t seed) {
  const Eigen::Vector3d corners[] = {{1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}};
  BubbleStore bubbles;
  for (std::size_t i = 0; i < radii.size(); ++i) {
    CounterRandom random(seed, i, 1);
    Eigen::Vector3d offset;
    for (double& x : offset) x = 0.1 * radii[i] * (2 * random.uniform() - 1);
    bubbles.add(bubbleAt(radii[i] * 0.5 * corners[i] + offset, radii[i], {0, 0, 0}, BubbleClass::air));
  }
  FoamSolver solver(dryParams());
  const StillPool space = emptySpace();
  for (int step = 0; step < 2000; ++step) solver.step(bubbles, space, 0.005);
  return bubbles;
}

TEST(Cluster, EqualBubblesRestAtTheExactSizesAndDistances) {
  constexpr double kAim = 1e-6;                                          // accuracy, G1
  const double r0 = 1e-3, growth[] = {1, 1.058267, 1.105099, 1.144843};  // r / r0 of 1 to 4 bubbles
  constexpr double kPrinted = 5e-7;                                      // the table's last figure
  for (std::size_t n = 1; n <= 4; ++n) {
    const BubbleStore bubbles = relaxedCluster(std::vector<double>(n, r0), 7 + n);
    for (std::size_t i = 0; i < n; ++i) {
      EXPECT_NEAR(bubbles.radius[i] / r0, growth[n - 1], kAim + kPrinted) << n << " bubbles";
      for (std::size_t j = i + 1; j < n; ++j)
        EXPECT_NEAR((bubbles.position[i] - bubbles.position[j]).norm() / bubbles.radius[i], 1, kAim)
            << n << " bubbles";
      EXPECT_NEAR(bubbles.volume[i] / bubbles.gas[i], 1, 1e-8);
    }
  }
}

TEST(Cluster, UnequalPairRestsAtTheModelsFixedPoint) {
  const BubbleStore bubbles = relaxedCluster({1e-3, 0.5e-3}, 3);
  EXPECT_NEAR(bubbles.radius[0], 1.008870e-3, 1.5e-9);  // accuracy, G2: printed to 5e-10
  EXPECT_NEAR(bubbles.radius[1], 0.599324e-3, 1.5e-9);
  EXPECT_NEAR((bubbles.position[0] - bubbles.position[1]).norm(), 0.878845e-3, 1.5e-9);
}

TEST(Cluster, WetPairsRestAtTheLengthOfTheirWetness) {
  const double wetness[] = {0, .2, .4, .6, .8, 1}, length[] = {1.0, 1.2649, 1.4832, 1.6733, 1.8439, 2};
  const double cellShare[] = {.84375, .91110, .95424, .98108, .99555, 1};  // accuracy, 4.1
  for (std::size_t k = 0; k < std::size(wetness); ++k) {
    FoamParams params = dryParams();
    params.wetness = params.wetnessAloft = wetness[k];
    params.volumeRate = 0;
    FoamSolver solver(params);
    BubbleStore bubbles;
    bubbles.add(bubbleAt({0, 0, 0}, 1e-3, {0, 0, 0}, BubbleClass::air));
    bubbles.add(bubbleAt({0.9e-3, 0, 0}, 1e-3, {0, 0, 0}, BubbleClass::air));
    const StillPool space = emptySpace();
    for (int step = 0; step < 2000; ++step) solver.step(bubbles, space, 0.005);
    EXPECT_NEAR((bubbles.position[0] - bubbles.position[1]).norm() / 1e-3, length[k], 1e-4);
    EXPECT_NEAR(bubbles.volume[0] / bubbles.gas[0], cellShare[k], 1e-4);
  }
}

}  // namespace
}  // namespace spume::foam::test
