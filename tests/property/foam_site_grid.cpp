#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <vector>

#include "foam/site_grid.h"

namespace spume::foam {
namespace {

using Eigen::Vector3d;

constexpr double kSize = 1e-3;  ///< of the cells [m]

std::int64_t cellAlong(const Vector3d& x, int axis) { return cellCoordinate(x[axis], kSize); }

TEST(SiteGrid, ARingHasAllSitesThatMatterOnce) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-3e-3, 3e-3), part(-1, 1);
  std::vector<Vector3d> position(400);
  for (Vector3d& x : position) x = {place(random), place(random), place(random)};
  const std::vector<double> radius(position.size(), 0.1e-3);
  std::vector<std::uint64_t> id(position.size());
  for (std::size_t i = 0; i < id.size(); ++i) id[i] = i;
  const SiteGrid grid(position, radius, id, kSize);
  for (int round = 0; round < 200; ++round) {
    const Vector3d centre = position[static_cast<std::size_t>(round)];
    const std::int64_t ring = round % 4;
    SiteGrid::Worth worth{{}, part(random)};
    for (auto& along : worth.along)
      for (std::int64_t k = -ring; k <= ring; ++k) along.push_back(part(random));
    std::vector<int> visits(position.size(), 0);
    grid.visitRing(centre, ring, worth, [&](const SiteGrid::Run& run) {
      for (std::int32_t s = run.begin; s < run.end; ++s) ++visits[grid.sites()[s].index];
    });
    for (std::size_t i = 0; i < position.size(); ++i) {
      std::int64_t farthest = 0;
      double sum = 0;
      for (int axis = 0; axis < 3; ++axis) {
        const std::int64_t away = cellAlong(position[i], axis) - cellAlong(centre, axis);
        farthest = std::max(farthest, std::abs(away));
        if (std::abs(away) <= ring) sum += worth.along[axis][away + ring];
      }
      if (farthest != ring)
        EXPECT_EQ(visits[i], 0);
      else if (sum > worth.least + 1e-9)
        EXPECT_EQ(visits[i], 1);
      else
        EXPECT_LE(visits[i], 1);
    }
  }
}

}  // namespace
}  // namespace spume::foam
