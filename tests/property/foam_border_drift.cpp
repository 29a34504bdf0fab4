// Borders drawn to Plateau's law.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "foam/border_drift.h"
#include "foam/volume_correction.h"
#include "tests/foam_fixtures.h"

namespace spume::foam::test {
namespace {

using Eigen::Vector3d;

/// Weightless dry foam that holds its volumes.
FoamParams dryFoam(double rate) {
  FoamParams params = makePreset(Preset::physical);
  params.gravity.setZero(), params.bursting = false;
  params.wetness = params.wetnessAloft = 0, params.contactDamping = 1;
  params.volumeMode = VolumeMode::newton, params.radiusLimit = 4;
  params.borderRate = rate;
  return params;
}

void run(const FoamParams& params, const LiquidSampler& liquid, double time, double dt,
         BubbleStore& bubbles) {
  FoamSolver solver(params);
  for (int step = 0; step < std::lround(time / dt); ++step) solver.step(bubbles, liquid, dt);
}

/// Area of all films and free surfaces of bubbles far from the liquid [m^2].
double surfaceArea(const BubbleStore& bubbles) {
  FoamTopology cells;
  PowerCells().compute(bubbles.position, bubbles.radius, bubbles.id, cells);
  double sum = total(cells.freeArea);
  for (const Film& film : cells.films) sum += film.area;
  return sum;
}

/// Unequal bubbles thrown together in the air.
BubbleStore thrownTogether(int count) {
  const Balls balls = randomFoam(count, 0.25, 1.6, 0.9, 4);
  BubbleStore bubbles;
  for (std::size_t i = 0; i < balls.size(); ++i)
    bubbles.add(
        bubbleAt(1e-3 * balls.position[i], 1e-3 * balls.radius[i], Vector3d::Zero(), BubbleClass::air));
  return bubbles;
}

TEST(BorderDrift, BringsADryFoamToLessArea) {
  constexpr double kTime = 2, kStep = 0.01;  // [s]
  constexpr double kLess = 0.005;  // of the area that springs alone leave; it was 0.011 when written
  const StillPool space = emptySpace();
  BubbleStore with = thrownTogether(80), without = with;
  run(dryFoam(4), space, kTime, kStep, with);
  run(dryFoam(0), space, kTime, kStep, without);
  EXPECT_LT(surfaceArea(with), (1 - kLess) * surfaceArea(without));
  for (const std::int32_t off : cellsOff(with, 1e-3))
    ADD_FAILURE() << "bubble " << off << " has lost its volume";
}

TEST(BorderDrift, DoesNotDependOnTheThreads) {
  const StillPool space = emptySpace();
  const auto withThreads = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    BubbleStore bubbles = thrownTogether(2500);
    run(dryFoam(4), space, 0.03, 0.01, bubbles);
    return bubbles.position;
  };
  const auto alone = withThreads(1);
  for (const std::size_t threads : {2, 5}) EXPECT_EQ(alone, withThreads(threads));
}

TEST(BorderDrift, MovesNoBubbleFarHoweverLongTheStep) {
  // At rest under springs first: what moves then is the drift and what it makes of their balance.
  const StillPool space = emptySpace();
  BubbleStore bubbles = thrownTogether(80);
  run(dryFoam(0), space, 2, 0.01, bubbles);
  const BubbleStore before = bubbles;
  run(dryFoam(100), space, 1, 1, bubbles);
  for (std::size_t i = 0; i < bubbles.size(); ++i)
    EXPECT_LT((bubbles.position[i] - before.position[i]).norm(), 0.1 * before.radius[i]);
}

TEST(BorderDrift, AClusterAtPlateausDistancesStays) {
  constexpr double kRadius = 1e-3;
  // Four equal dry balls at their rest length, one radius apart: the radii change with the volumes they hold.
  BubbleStore bubbles;
  for (const Vector3d& corner :
       {Vector3d(1, 1, 1), Vector3d(1, -1, -1), Vector3d(-1, 1, -1), Vector3d(-1, -1, 1)})
    bubbles.add(bubbleAt(kRadius / std::sqrt(8.0) * corner, kRadius, Vector3d::Zero(), BubbleClass::air));
  const StillPool space = emptySpace();
  FoamParams params = dryFoam(2);
  params.solverTolerance = 1e-10;  // the default leaves the four unlike by its own share
  run(params, space, 5, 0.01, bubbles);
  const BubbleStore before = bubbles;
  run(params, space, 0.1, 0.01, bubbles);
  for (std::size_t i = 0; i < bubbles.size(); ++i)
    EXPECT_LT((bubbles.position[i] - before.position[i]).norm(), 1e-6 * kRadius);
  const double reach = bubbles.position[0].norm();
  for (const Vector3d& x : bubbles.position) EXPECT_NEAR(x.norm(), reach, 1e-9 * kRadius);
}

TEST(BorderDrift, LeavesWhatIsUnderWaterAlone) {
  FoamParams params = waterParams(Preset::physical);
  const StillPool pool = deepPool(params);
  const auto afterSteps = [&](double rate) {
    BubbleStore bubbles;
    for (int i = 0; i < 40; ++i) {
      CounterRandom random(3, static_cast<std::uint64_t>(i), 0);
      const double x = random.uniform(), y = random.uniform(), z = random.uniform();
      bubbles.add(bubbleAt(6e-3 * Vector3d(x, y, z), 1e-3));
    }
    params.borderRate = rate;
    run(params, pool, 0.1, 0.01, bubbles);
    return bubbles.position;
  };
  EXPECT_EQ(afterSteps(0), afterSteps(5));
}

}  // namespace
}  // namespace spume::foam::test
