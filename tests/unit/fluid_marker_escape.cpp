// Markers that leave their liquid or their air, and how fast streams meet.
#include <gtest/gtest.h>

#include <numeric>

#include "fluid/impact_speed.h"
#include "fluid/marker_escape.h"
#include "tests/support/fluid_fields.h"
#include "tests/support/marker_pool.h"

namespace spume::fluid {
namespace {

using namespace test;

TEST(MarkerEscape, SharesAddUpToTheAirOfTheSeededCells) {
  Pool pool(24, sphere);
  pool.seed();
  MarkerEscape escape(pool.grid);
  const double air = escape.refreshGas(pool.scene(), pool.phi, pool.positive);
  const double shares = std::accumulate(pool.positive.gas.begin(), pool.positive.gas.end(), 0.0);
  EXPECT_NEAR(shares / air, 1, 1e-5);  // float shares
  // The air between the sphere and one 3 cells larger, up to the cells that the band cuts.
  const double inner = std::pow(0.25, 3), outer = std::pow(0.25 + 3 * pool.grid.dx, 3);
  EXPECT_NEAR(air / (4.18879 * (outer - inner)), 1, 0.1);
}

TEST(MarkerEscape, FreezesTheShareUnderTheSurface) {
  Pool pool(16, flat);
  pool.positive.append(8, 8.5f, 8, 0.5f);
  MarkerEscape escape(pool.grid);
  escape.refreshGas(pool.scene(), pool.phi, pool.positive);
  const float share = pool.positive.gas[0];
  EXPECT_NEAR(share, pool.grid.cellVolume(), 1e-4 * pool.grid.cellVolume());
  pool.positive.y[0] = 7.5f;
  escape.refreshGas(pool.scene(), pool.phi, pool.positive);
  EXPECT_EQ(pool.positive.gas[0], share);
}

/// Two streams side by side under a flat surface: a jet to the right of x = 1/2, a pool at rest to the left;
/// above the surface the air blows at 10 m/s.
Eigen::Vector3d jetIntoPool(const Eigen::Vector3d& x) {
  if (x.y() > 0.5) return {10, 0, 0};
  return {0, x.x() > 0.5 ? -1.6 : 0.0, 0};
}

TEST(ImpactSpeed, IsTheDifferenceOfTheStreamsWhereverInTheirLayer) {
  for (const int cells : {16, 32}) {
    Pool pool(cells, flat);
    pool.params.impactReach = 0.2;
    const MacVelocity streams = macField(pool.grid, jetIntoPool);
    for (const double x : {0.44, 0.46, 0.56})
      EXPECT_NEAR(impactSpeed(pool.scene(), pool.phi, streams, {x, 0.4, 0.5}), 1.6, 1e-6) << cells;
    EXPECT_EQ(impactSpeed(pool.scene(), pool.phi, streams, {0.25, 0.25, 0.5}), 0) << cells;  // pool alone
    EXPECT_EQ(impactSpeed(pool.scene(), pool.phi, streams, {0.8, 0.25, 0.5}), 0) << cells;   // jet alone
    EXPECT_EQ(impactSpeed(pool.scene(), pool.phi, streams, {0.5, 0.8, 0.5}), 0) << cells;    // air alone
  }
}

TEST(ImpactSpeed, ReachesThreeCellsWhereTheGridIsCoarse) {
  Pool pool(16, flat);
  pool.params.impactReach = 1e-4;
  const MacVelocity streams = macField(pool.grid, jetIntoPool);
  EXPECT_NEAR(impactSpeed(pool.scene(), pool.phi, streams, {0.5, 0.3, 0.5}), 1.6, 1e-6);
  EXPECT_EQ(impactSpeed(pool.scene(), pool.phi, streams, {0.5 - 4 * pool.grid.dx, 0.3, 0.5}), 0);
}

TEST(MarkerEscape, ReleasesMarkersBelowTheEscapeDepthOnly) {
  Pool pool(16, flat);
  pool.positive.append(8, 7.1f, 8, 0.5f);  // 0.9 cells deep
  pool.positive.append(8, 6.9f, 8, 0.1f);  // 1.1 cells deep
  pool.positive.append(8, 8.4f, 8, 0.4f);
  pool.positive.gas = {1, 2, 3};
  std::vector<EscapedMarker> escaped;
  MarkerEscape escape(pool.grid);
  const MacVelocity sink = macField(pool.grid, [](const auto&) { return Eigen::Vector3d(0, -1, 0); });
  escape.releaseEscaped(pool.scene(), pool.phi, sink, pool.positive, escaped);
  ASSERT_EQ(escaped.size(), 1u);
  EXPECT_EQ(escaped[0].gas, 2);
  EXPECT_EQ(escaped[0].speed, 0);  // all sinks together
  EXPECT_NEAR(escaped[0].position.y(), 6.9 * pool.grid.dx, 1e-6);
  EXPECT_NEAR(escaped[0].velocity.y(), -1, 1e-6);
  ASSERT_EQ(pool.positive.size(), 2u);
  EXPECT_EQ(pool.positive.escaped[0], 1);  // flagged, but not deep enough to go
  EXPECT_EQ(pool.positive.escaped[1], 0);
}

}  // namespace
}  // namespace spume::fluid
