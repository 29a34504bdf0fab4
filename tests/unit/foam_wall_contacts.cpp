// Which bubbles wall contacts name as doubtful, and whether they foresee their own changes.
#include <gtest/gtest.h>

#include <algorithm>

#include "foam/wall_contacts.h"
#include "tests/foam_fixtures.h"

namespace spume::foam::test {
namespace {

constexpr double kRadius = 0.4e-3, kStep = 5e-3;  // [m], [s]

/// Bubbles in a row above a floor at y = 0, each higher than the last; weightless and without liquid.
struct RowAboveAFloor {
  FoamParams params = makePreset(Preset::physical);
  BubbleStore bubbles;
  BlockSystem system;
  std::vector<double> expected, mass;
  std::vector<NearWalls> walls;
  Vectors3 before, change, impulse;
  WallContacts contacts;

  explicit RowAboveAFloor(int count) {
    for (int i = 0; i < count; ++i)
      bubbles.add(bubbleAt({4 * i * kRadius, (0.955 + 0.01 * i) * kRadius, 0}, kRadius));
    StillPoolParams pool;
    pool.lower = {-1e3, 0, -1e3}, pool.upper = {1e3, 1e3, 1e3};
    pool.surfaceHeight = -1e3, pool.closed = {false, false, true, false, false, false};
    const StillPool floor(pool);
    Surroundings around;
    around.sample(floor, bubbles.positions());
    findNearWalls(floor, around, bubbles, std::vector<double>(bubbles.size(), 4 * kRadius), walls);
    const std::size_t n = bubbles.size();
    system.own.assign(n, Eigen::Matrix3d::Identity()), system.start.assign(n + 1, 0);
    expected.assign(n, 0.0), mass.assign(n, 1.0);
    change.assign(n, Eigen::Vector3d::Zero()), before = change, impulse = change;
    contacts.describe(params, around, std::vector<double>(n, 0.0), bubbles);
    contacts.begin(walls, before, expected, mass, kStep, change, system, impulse);
  }

  std::vector<std::int32_t> update() {
    const Vectors3 left(bubbles.size(), Eigen::Vector3d::Zero());
    return contacts.update(before, left, kStep, change, system, impulse);
  }
  void moveAll(double radii) {
    for (auto& v : change) v.y() += radii * kRadius / kStep;
  }
};

TEST(WallContacts, ForeseeWhatTheirUpdateChanges) {
  RowAboveAFloor row(20);
  for (const double radii : {-0.07, 0.03, 0.1, -0.25}) {
    row.moveAll(radii);
    std::vector<std::int32_t> foreseen;
    for (std::int32_t i = 0; i < 20; ++i)
      if (row.contacts.isChangedBy(i, row.before[i] + row.change[i], kStep)) foreseen.push_back(i);
    EXPECT_EQ(foreseen, row.update()) << radii;
    EXPECT_FALSE(foreseen.empty()) << radii;
  }
}

/// Doubtful is who would change if velocities went on to change as they have done, and no others.
TEST(WallContacts, DoubtThoseNearAChangeAlone) {
  RowAboveAFloor row(40);
  row.moveAll(-0.05), row.update();
  row.moveAll(-0.01), row.update();
  const std::vector<std::int32_t> doubtful = row.contacts.doubtful();
  EXPECT_LE(doubtful.size(), 10u);
  row.moveAll(-0.01);
  const std::vector<std::int32_t> sunk = row.update();
  row.moveAll(0.02);
  std::vector<std::int32_t> changed = sunk;
  for (std::int32_t i = 0; i < 40; ++i)
    if (row.contacts.isChangedBy(i, row.before[i] + row.change[i], kStep)) changed.push_back(i);
  EXPECT_FALSE(changed.empty());
  for (const std::int32_t i : changed)
    EXPECT_TRUE(std::binary_search(doubtful.begin(), doubtful.end(), i)) << i;
}

}  // namespace
}  // namespace spume::foam::test
