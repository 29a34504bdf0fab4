// How much liquid each marker stands for.
#include <gtest/gtest.h>

#include <numeric>

#include "fluid/marker_shares.h"
#include "tests/support/fluid_fields.h"
#include "tests/support/marker_pool.h"

namespace spume::fluid {
namespace {

using namespace test;

/// Liquid of the cells that hold markers, and what the markers say they stand for.
double volumeOfShares(const MarkerSet& markers) {
  return std::accumulate(markers.gas.begin(), markers.gas.end(), 0.0);
}

TEST(MarkerShares, OfLiquidAreKeptWherePhiIsInDoubt) {
  Pool pool(24, flat);
  pool.seed();
  MarkerShares shares(pool.grid);
  shares.refreshLiquid(pool.scene(), pool.phi, pool.positive, pool.negative);
  const LargeVector<float> before = pool.negative.gas;
  // The grid loses a quarter of a cell of liquid everywhere, and one marker of the air says that it is wrong.
  pool.phi = levelSet(pool.grid, [&](const auto& x) { return flat(x) + 0.25 * pool.grid.dx; });
  pool.positive.escaped[0] = 1;
  const Eigen::Array3i lost(static_cast<int>(pool.positive.x[0]), static_cast<int>(pool.positive.y[0]),
                            static_cast<int>(pool.positive.z[0]));
  shares.refreshLiquid(pool.scene(), pool.phi, pool.positive, pool.negative);
  int kept = 0, divided = 0;
  for (std::size_t n = 0; n < before.size(); ++n) {
    const Eigen::Array3i cell(static_cast<int>(pool.negative.x[n]), static_cast<int>(pool.negative.y[n]),
                              static_cast<int>(pool.negative.z[n]));
    if (cell.y() != 11) continue;  // the cells that hold the surface's liquid
    const bool near = (cell - lost).abs().maxCoeff() <= 1;
    (near ? kept : divided) += 1;
    if (near)
      EXPECT_EQ(pool.negative.gas[n], before[n]);
    else
      EXPECT_NEAR(pool.negative.gas[n] / before[n], 0.75, 1e-3);  // float phi
  }
  EXPECT_GT(kept, 0);
  EXPECT_GT(divided, 0);
}

TEST(MarkerShares, OfLiquidAreTheSameOnAnyNumberOfThreads) {
  const auto run = [](int threads) {
    return onThreads(threads, [] {
      Pool pool(24, sphere);
      pool.seed();
      for (std::size_t n = 0; n < pool.negative.size(); n += 100) pool.negative.escaped[n] = 1;
      MarkerShares(pool.grid).refreshLiquid(pool.scene(), pool.phi, pool.positive, pool.negative);
      return pool.negative;
    });
  };
  const MarkerSet one = run(1), four = run(4);
  EXPECT_EQ(one.gas, four.gas);
}

/// A marker that stands out by less than its radius has not escaped: its part of the cell must not be given
/// to the others, or it counts twice once it has.
TEST(MarkerShares, OfLiquidGoToAllThatHaveNotEscaped) {
  Pool pool(16, flat);
  pool.negative.append(8.5f, 7.5f, 8.5f, 0.1f);
  pool.negative.append(8.5f, 7.9f, 8.5f, 0.1f);
  pool.phi = levelSet(pool.grid, [&](const auto& x) { return flat(x) + 0.15 * pool.grid.dx; });  // 0.05 out
  MarkerShares shares(pool.grid);
  const double given = shares.refreshLiquid(pool.scene(), pool.phi, pool.positive, pool.negative);
  EXPECT_NEAR(given / pool.grid.cellVolume(), 0.85, 1e-3);  // float phi
  EXPECT_EQ(pool.negative.gas[0], pool.negative.gas[1]);
  EXPECT_NEAR(volumeOfShares(pool.negative) / given, 1, 1e-6);  // float shares
}

TEST(MarkerSeeder, LeavesTheLiquidOfSurplusMarkersToTheirCell) {
  Pool pool(16, flat);
  const float volume = static_cast<float>(pool.grid.cellVolume());
  for (int n = 0; n < 4 * pool.params.markersPerCell; ++n) {
    pool.negative.append(8.5f, 7.2f, 8.5f, 0.3f);
    pool.negative.gas.back() = volume;
  }
  const double before = volumeOfShares(pool.negative);
  const std::size_t count = pool.negative.size();
  pool.seed();
  std::size_t left = 0;
  for (std::size_t n = 0; n < pool.negative.size(); ++n) left += pool.negative.gas[n] > 0;
  EXPECT_LT(left, count);
  EXPECT_NEAR(volumeOfShares(pool.negative) / before, 1, 1e-6);  // float shares
}

}  // namespace
}  // namespace spume::fluid
