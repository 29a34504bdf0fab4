// Geometry measured in part or kept from a step to the next is what measuring all of it gives, to the last
// bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "foam/kept_geometry.h"
#include "foam/space_order.h"
#include "foam/volume_correction.h"
#include "tests/foam_fixtures.h"
#include "tests/support/foam_relaxed.h"

namespace spume::foam::test {
namespace {

template <typename T>
void expectSameBits(const std::vector<T>& a, const std::vector<T>& b, const char* what) {
  ASSERT_EQ(a.size(), b.size()) << what;
  EXPECT_TRUE(a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0) << what;
}

void expectSameGeometry(const FoamTopology& a, const FoamTopology& b) {
  expectSameBits(a.volume, b.volume, "volume"), expectSameBits(a.freeArea, b.freeArea, "freeArea");
  expectSameBits(a.filmArea, b.filmArea, "filmArea"), expectSameBits(a.hidden, b.hidden, "hidden");
  ASSERT_EQ(a.overlaps.size(), b.overlaps.size());
  ASSERT_EQ(a.films.size(), b.films.size());
  std::size_t others = 0;
  for (std::size_t p = 0; p < a.overlaps.size(); ++p) {
    const OverlapPair &x = a.overlaps[p], &y = b.overlaps[p];
    others += x.i != y.i || x.j != y.j || x.distance != y.distance || x.film != y.film;
  }
  for (std::size_t f = 0; f < a.films.size(); ++f) {
    const Film &x = a.films[f], &y = b.films[f];
    others +=
        x.i != y.i || x.j != y.j || x.distance != y.distance || x.height != y.height || x.area != y.area;
  }
  EXPECT_EQ(others, 0u);
}

/// A relaxed foam in space order, pressed into the corner of three closed walls, a little askew by what
/// distance from a corner is: bubbles are cut by the planes of their neighbours, too.
class FoamInACorner {
 public:
  BubbleStore bubbles;

  FoamInACorner() : pool_(corner()) {
    const Balls balls = relaxedFoam(3000, 0.4, 61);
    BubbleStore born;
    for (std::size_t i = 0; i < balls.size(); ++i)
      born.add(bubbleAt(balls.position[i], balls.radius[i] * (i % 40 == 0 ? 0.5 : 1)));
    std::vector<std::int32_t> order;
    sortInSpace(born.position, order);
    bubbles.gather(born, order);
  }
  std::vector<NearWalls> walls() const {
    Surroundings around;
    around.sample(pool_, bubbles.positions());
    std::vector<NearWalls> walls;
    findNearWalls(pool_, around, bubbles, bubbles.radius, walls);
    // Bent walls: neighbours do not have the same plane.
    for (std::size_t i = 0; i < walls.size(); ++i)
      for (int k = 0; k < walls[i].count; ++k)
        walls[i].wall[k].away += 0.1 * Eigen::Vector3d(std::sin(3e3 * bubbles.position[i].y()), 0, 0.3);
    return walls;
  }
  FoamTopology measured() const {
    FoamTopology topology;
    WallCells().compute(bubbles, walls(), topology);
    return topology;
  }

 private:
  static StillPoolParams corner() {
    StillPoolParams pool;
    pool.lower.setConstant(1e-3), pool.upper.setConstant(1);
    pool.closed = {true, false, true, false, true, false};
    return pool;
  }

  StillPool pool_;
};

/// Gives every `share`th bubble another radius, some of them so that they meet balls they have not met.
std::vector<std::int32_t> changeRadii(std::size_t share, BubbleStore& bubbles) {
  std::vector<std::int32_t> changed;
  for (std::size_t i = 0; i < bubbles.size(); ++i) {
    CounterRandom random(7, bubbles.id[i], share);
    if (random.uniform() * static_cast<double>(share) > 1) continue;
    bubbles.radius[i] *= 0.7 + 0.6 * random.uniform();
    changed.push_back(static_cast<std::int32_t>(i));
  }
  return changed;
}

TEST(PartMeasurement, IsAMeasurementOfTheWhole) {
  FoamInACorner foam;
  FoamTopology topology = foam.measured();
  PartMeasurement part;
  part.begin(foam.bubbles, foam.walls());
  Neighbours neighbours;
  std::size_t pairs = topology.overlaps.size();
  for (const std::size_t share : {300, 1500, 30, 100000}) {
    neighbours.build(foam.bubbles.size(), topology.overlaps);
    const std::vector<std::int32_t> changed = changeRadii(share, foam.bubbles);
    part.update(foam.bubbles, foam.walls(), changed, neighbours, topology);
    expectSameGeometry(topology, foam.measured());
    const std::size_t before = std::exchange(pairs, topology.overlaps.size());
    EXPECT_EQ(before == pairs, changed.empty());
    EXPECT_LT(part.rows(), foam.bubbles.size() / (share > 300 ? 4 : 1) + 1);
  }
}

/// The plane of a bubble at a wall may cut one that the bubble itself does not meet.
TEST(PartMeasurement, KnowsWhomPlanesCut) {
  BubbleStore bubbles;
  bubbles.add(bubbleAt({0, -0.5, 0}, 1)), bubbles.add(bubbleAt({1.9, -0.7, 0}, 0.8));
  std::vector<NearWalls> walls(2);
  walls[0].count = 1, walls[0].wall[0].psi = -0.5, walls[0].wall[0].away = {0, 1, 0};
  FoamTopology topology, anew;
  WallCells().compute(bubbles, walls, topology);
  EXPECT_LT(topology.volume[1], 0.9 * ballVolume(0.8));
  Neighbours none;
  none.build(2, topology.overlaps);
  PartMeasurement part;
  part.begin(bubbles, walls);
  for (const double radius : {1.05, 0.6}) {
    const double before = topology.volume[1];
    bubbles.radius[0] = radius;
    part.update(bubbles, walls, {0}, none, topology);
    WallCells().compute(bubbles, walls, anew);
    EXPECT_TRUE(topology.overlaps.empty());
    EXPECT_NE(topology.volume[1], before);
    expectSameGeometry(topology, anew);
  }
}

/// Bubbles are born, in free space and within others, vanish, and are moved and changed by somebody.
TEST(KeptGeometry, IsAMeasurementOfTheWhole) {
  FoamInACorner foam;
  for (int round = 0; round < 4; ++round) {
    FoamTopology topology = foam.measured();
    KeptGeometry kept;
    kept.note(foam.bubbles, foam.walls());
    BubbleStore born;
    born.nextId = foam.bubbles.nextId;
    std::vector<std::uint8_t> gone(foam.bubbles.size(), 0);
    const std::size_t n = foam.bubbles.size();
    if (round > 0)
      for (int k = 0; k < 7; ++k) gone[(n / 8) * k + 11 * round] = 1;
    if (round > 1) {
      changeRadii(1000, foam.bubbles);
      foam.bubbles.position[n / 3] += Eigen::Vector3d(0.2e-3, 0, 0);
    }
    const Eigen::Vector3d low = foam.bubbles.position[n / 5];
    foam.bubbles.remove(gone);
    if (round != 1)
      for (int k = 0; k < 5; ++k)
        foam.bubbles.add(bubbleAt(low + 0.9e-3 * Eigen::Vector3d(k, 0.1, 0.3 * k), 0.4e-3));
    std::vector<std::int32_t> order(foam.bubbles.size());
    for (std::size_t k = 0; k < order.size(); ++k) order[k] = static_cast<std::int32_t>(k);
    if (round != 1)
      std::rotate(order.begin() + static_cast<std::ptrdiff_t>(n / 5), order.end() - 5, order.end());
    const BubbleStore unsorted = foam.bubbles;
    foam.bubbles.gather(unsorted, order);
    Neighbours neighbours, anew;
    ASSERT_TRUE(kept.renew(foam.bubbles, foam.walls(), topology, neighbours)) << round;
    expectSameGeometry(topology, foam.measured());
    anew.build(foam.bubbles.size(), topology.overlaps);
    expectSameBits(neighbours.other, anew.other, "neighbours");
    EXPECT_FALSE(kept.renew(foam.bubbles, foam.walls(), topology, neighbours)) << "it has been used";
  }
}

TEST(KeptGeometry, IsNotUsedInAnotherOrderOrAfterMuchHasChanged) {
  FoamInACorner foam;
  const std::size_t n = foam.bubbles.size();
  FoamTopology topology = foam.measured();
  Neighbours neighbours;
  KeptGeometry kept;
  EXPECT_FALSE(kept.renew(foam.bubbles, foam.walls(), topology, neighbours));
  kept.note(foam.bubbles, foam.walls());
  kept.forget();
  EXPECT_FALSE(kept.renew(foam.bubbles, foam.walls(), topology, neighbours));
  kept.note(foam.bubbles, foam.walls());
  std::vector<std::int32_t> order(n);
  for (std::size_t k = 0; k < n; ++k) order[k] = static_cast<std::int32_t>(k);
  std::swap(order[10], order[20]);
  BubbleStore turned;
  turned.gather(foam.bubbles, order);
  EXPECT_FALSE(kept.renew(turned, foam.walls(), topology, neighbours));
  kept.note(foam.bubbles, foam.walls());
  for (std::size_t i = 0; i < n; i += 10) foam.bubbles.radius[i] *= 1.001;
  EXPECT_FALSE(kept.renew(foam.bubbles, foam.walls(), topology, neighbours));
}

/// A solver that has kept something against one that has not, while bubbles grow, are born and vanish.
TEST(KeptGeometry, DoesNotShowInAStep) {
  FoamInACorner foam;
  FoamParams params = makePreset(Preset::physical);
  params.volumeMode = VolumeMode::newton, params.volumeTolerance = 5e-3, params.bursting = false;
  StillPoolParams box;
  box.gravity = params.gravity, box.density = params.density, box.surfaceHeight = 5e-3;
  box.lower.setConstant(0), box.upper.setConstant(0.02);
  box.closed = {true, true, true, true, true, true};
  const StillPool pool(box);
  BubbleStore kept = foam.bubbles;
  std::vector<std::int32_t> order(kept.size());
  for (std::size_t k = 0; k < order.size(); ++k) order[kept.id[k]] = static_cast<std::int32_t>(k);
  kept.gather(foam.bubbles, order);
  FoamSolver solver(params);
  for (int step = 0; step < 6; ++step) {
    BubbleStore resumed = kept;
    solver.step(kept, pool, 5e-3);
    FoamSolver fresh(params);
    fresh.step(resumed, pool, 5e-3);
    expectSameBits(kept.position, resumed.position, "position");
    expectSameBits(kept.radius, resumed.radius, "radius");
    expectSameBits(kept.volume, resumed.volume, "volume");
    expectSameGeometry(solver.topology(), fresh.topology());
    for (double& gas : kept.gas) gas *= 1.0005;
    if (step % 2 == 0) kept.add(bubbleAt({5e-3, 4e-3, 3e-3 + 1e-3 * step}, 0.4e-3));
    std::vector<std::uint8_t> gone(kept.size(), 0);
    gone[100 * step + 50] = step % 3 == 1;
    kept.remove(gone);
  }
}

}  // namespace
}  // namespace spume::foam::test
