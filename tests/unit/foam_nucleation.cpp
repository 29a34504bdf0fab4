// Nucleation sites on solids.
#include <gtest/gtest.h>

#include <cmath>

#include "foam/nucleation.h"
#include "tests/foam_fixtures.h"

namespace spume::foam::test {
namespace {

const Eigen::Vector3d kLower(-0.05, -0.1, -0.05), kUpper(0.05, 0, 0.05);

/// A pool 10 cm deep in a box of 10 x 10 cm.
StillPool tank(double surface = 0.2) {
  StillPoolParams pool;
  pool.lower = kLower, pool.upper = {0.05, 1, 0.05};
  pool.closed = {true, true, true, false, true, true};
  pool.surfaceHeight = surface;
  return StillPool(pool);
}

NucleationParams scratches() {
  NucleationParams params;
  params.density = 2e4, params.waiting = 0.2;
  params.radius = {RadiusLaw::uniform, 0, 0, 0, 1e-4, 2e-4};
  return params;
}

TEST(Nucleation, SitesLieOnTheWallsAtTheirDensity) {
  const auto sites = findNucleationSites(scratches(), 0, tank(), kLower, kUpper, 1);
  const double area = 5 * 0.01, expected = 2e4 * area;  // four sides and the floor
  EXPECT_NEAR(static_cast<double>(sites.size()), expected, 4 * std::sqrt(expected));  // Poisson, 4 sigma
  Eigen::Index floor = 0;
  for (const NucleationSite& site : sites) {
    Eigen::VectorXd psi(1);
    tank().psi(site.position, psi);
    EXPECT_NEAR(psi[0], 0, 1e-12);
    EXPECT_NEAR(site.away.norm(), 1, 1e-12);
    floor += site.away.y() == 1;
  }
  EXPECT_NEAR(static_cast<double>(floor), expected / 5, 4 * std::sqrt(expected / 5));
}

TEST(Nucleation, OnlyTheSolidAskedForHasSites) {
  NucleationParams params = scratches();
  params.solid = 0;
  EXPECT_TRUE(findNucleationSites(params, 0, tank(), kLower, kUpper, 1).empty());
  params.solid = -1;
  EXPECT_FALSE(findNucleationSites(params, 0, tank(), kLower, kUpper, 1).empty());
}

/// Runs the sites of a tank for `end` seconds; bubbles leave the moment they appear.
std::size_t births(const NucleationParams& params, const StillPool& pool, double end, double dt) {
  auto sites = findNucleationSites(params, 0, pool, kLower, kUpper, 1);
  BubbleStore bubbles;
  std::size_t count = 0;
  for (int step = 1; step * dt <= end * (1 + 1e-12); ++step)
    for (const Nucleated& born : nucleate({params}, pool, bubbles, step * dt, 1, sites)) {
      sites[born.site].bubble = 1;  // the id of no bubble: it has left
      ++count;
    }
  return count;
}

TEST(Nucleation, SitesBreedAtTheirRateAtAnyStep) {
  // Each site waits 0.2 s on average and up to one step more, which it takes to notice: Poisson, 4 sigma.
  for (const double dt : {0.001, 0.02}) {
    const double sites = 1000, expected = sites * 3 / (0.2 + 0.5 * dt + dt);
    EXPECT_NEAR(static_cast<double>(births(scratches(), tank(), 3, dt)), expected, 0.06 * expected) << dt;
  }
}

TEST(Nucleation, NothingAppearsAboveTheLiquidOrOutOfHours) {
  EXPECT_EQ(births(scratches(), tank(-0.2), 1, 0.01), 0u);
  NucleationParams params = scratches();
  params.start = 2;
  EXPECT_EQ(births(params, tank(), 2, 0.01), 0u);
  params.start = 0, params.stop = 0;
  EXPECT_EQ(births(params, tank(), 1, 0.01), 0u);
}

TEST(Nucleation, ASiteWaitsUntilItsBubbleHasLeft) {
  NucleationParams params = scratches();
  params.waiting = 1e-4;
  auto sites = findNucleationSites(params, 0, tank(), kLower, kUpper, 1);
  sites.resize(1);
  BubbleStore bubbles;
  const auto first = nucleate({params}, tank(), bubbles, 1, 1, sites);
  ASSERT_EQ(first.size(), 1u);
  sites[0].bubble = bubbles.add(first[0].bubble);
  const double r = first[0].bubble.radius;
  EXPECT_LT((bubbles.position[0] - sites[0].position).norm(), r);  // pressed on the wall
  EXPECT_GE(r, 1e-4);
  EXPECT_LE(r, 2e-4);
  EXPECT_TRUE(nucleate({params}, tank(), bubbles, 2, 1, sites).empty());
  bubbles.position[0] += 3 * r * sites[0].away;
  nucleate({params}, tank(), bubbles, 3, 1, sites);  // notices
  EXPECT_EQ(nucleate({params}, tank(), bubbles, 4, 1, sites).size(), 1u);
}

}  // namespace
}  // namespace spume::foam::test
