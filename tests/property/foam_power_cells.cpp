#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "foam/power_cells.h"
#include "tests/support/foam_balls.h"

namespace spume::foam::test {
namespace {

using Eigen::Vector3d;

struct CellByRays {
  double volume = 0, freeArea = 0, filmArea = 0;
};

/// The same cell from the definition alone: rays from the centre, each cut by every other ball's radical
/// plane. A ray is inside the cell from the last plane it enters by to the first it leaves by.
CellByRays castRays(const Balls& balls, std::size_t i, int rays) {
  CellByRays cell;
  const double r = balls.radius[i], dOmega = 4 * std::numbers::pi / rays;
  const double golden = std::numbers::pi * (3 - std::sqrt(5.));
  for (int k = 0; k < rays; ++k) {
    const double z = 1 - (2 * k + 1.0) / rays, ring = std::sqrt(1 - z * z);
    const Vector3d ray(ring * std::cos(golden * k), ring * std::sin(golden * k), z);
    double enter = 0, leave = r, enterSlope = 0, leaveSlope = 0;
    for (std::size_t j = 0; j < balls.size(); ++j) {
      const Vector3d to = balls.position[j] - balls.position[i];
      const double d = to.norm(), slope = ray.dot(to) / d;
      if (j == i || d > r + balls.radius[j]) continue;
      const double height = (d * d + r * r - balls.radius[j] * balls.radius[j]) / (2 * d), t = height / slope;
      if (slope > 0 && t < leave) leave = t, leaveSlope = slope;
      if (slope < 0 && t > enter) enter = t, enterSlope = slope;
    }
    if (leave <= enter) continue;
    cell.volume += dOmega * (leave * leave * leave - enter * enter * enter) / 3;
    if (leave == r) cell.freeArea += dOmega * r * r;
    if (leave < r) cell.filmArea += dOmega * leave * leave / leaveSlope;
    if (enter > 0) cell.filmArea -= dOmega * enter * enter / enterSlope;
  }
  return cell;
}

TEST(PowerCells, RaysFromTheCentresMeasureTheSameCells) {
  constexpr int kRays = 20000;
  /// A spiral of n rays samples a spherical area to about n^(-3/4) of the ball, here 6e-4; 3 times that.
  constexpr double kSampling = 2e-3;
  /// Planes near a centre give grazing rays of unbounded weight: areas are compared on the sum over the foam.
  constexpr double kSumOfAreas = 1e-2;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const Balls balls = randomFoam(40, .5, 4, 1.2, seed);
    const FoamTopology t = powerCellsOf(balls);
    double filmArea = 0;
    for (std::size_t i = 0; i < balls.size(); ++i) {
      const CellByRays cell = castRays(balls, i, kRays);
      const double r = balls.radius[i];
      EXPECT_NEAR(t.volume[i], cell.volume, kSampling * ballVolume(r)) << "seed " << seed << " ball " << i;
      EXPECT_NEAR(t.freeArea[i], cell.freeArea, kSampling * 4 * std::numbers::pi * r * r);
      EXPECT_EQ(t.hidden[i], cell.volume == 0);
      filmArea += cell.filmArea;
    }
    EXPECT_NEAR(total(t.filmArea), filmArea, kSumOfAreas * filmArea);
  }
}

TEST(PowerCells, CellsAddUpToTheUnion) {
  const Balls balls = randomFoam(1000, .5, 4, .9, 5);
  double side = 0;
  for (const auto& x : balls.position) side = std::max(side, x.maxCoeff());
  const double margin = *std::max_element(balls.radius.begin(), balls.radius.end());
  side += 2 * margin;
  constexpr int kSamples = 100000;
  int inside = 0;
  for (int k = 0; k < kSamples; ++k) {
    CounterRandom random(9, static_cast<std::uint64_t>(k), 1);
    const Vector3d unit(random.uniform(), random.uniform(), random.uniform());
    const Vector3d p = side * unit - Vector3d::Constant(margin);
    for (std::size_t i = 0; i < balls.size(); ++i)
      if ((balls.position[i] - p).squaredNorm() < balls.radius[i] * balls.radius[i]) {
        ++inside;
        break;
      }
  }
  const double share = static_cast<double>(inside) / kSamples;
  const double sigma = std::sqrt((1 - share) / (share * kSamples));
  const double sampled = share * side * side * side;
  EXPECT_NEAR(total(powerCellsOf(balls).volume), sampled, 4 * sigma * sampled);
}

/// The area vectors of a closed polyhedron add up to zero.
TEST(PowerCells, FilmsOfAnInteriorCellClose) {
  constexpr double kRoundOff = 1e-11;
  const Balls balls = randomFoam(400, .2, 2, 4, 8);
  const FoamTopology t = powerCellsOf(balls);
  std::vector<Vector3d> closure(balls.size(), Vector3d::Zero());
  for (const Film& film : t.films) {
    const Vector3d normal = (balls.position[film.j] - balls.position[film.i]) / film.distance;
    closure[film.i] += film.area * normal;
    closure[film.j] -= film.area * normal;
  }
  int closed = 0;
  for (std::size_t i = 0; i < balls.size(); ++i) {
    if (t.freeArea[i] > 0 || t.hidden[i]) continue;
    ++closed;
    EXPECT_LT(closure[i].norm(), kRoundOff * balls.radius[i] * balls.radius[i]);
  }
  EXPECT_GT(closed, 50);
}

template <typename T>
auto bitsOf(const T& value) {
  if constexpr (std::is_same_v<T, OverlapPair>)
    return std::make_tuple(value.i, value.j, value.distance, value.film);
  else if constexpr (std::is_same_v<T, Film>)
    return std::make_tuple(value.i, value.j, value.distance, value.height, value.area);
  else
    return value;
}

template <typename T>
bool sameBits(const std::vector<T>& a, const std::vector<T>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const T& x, const T& y) { return bitsOf(x) == bitsOf(y); });
}

void expectSameBits(const FoamTopology& a, const FoamTopology& b) {
  EXPECT_TRUE(sameBits(a.overlaps, b.overlaps));
  EXPECT_TRUE(sameBits(a.films, b.films));
  EXPECT_TRUE(sameBits(a.volume, b.volume));
  EXPECT_TRUE(sameBits(a.freeArea, b.freeArea));
  EXPECT_TRUE(sameBits(a.filmArea, b.filmArea));
  EXPECT_TRUE(sameBits(a.hidden, b.hidden));
}

TEST(PowerCells, ThreadsDoNotChangeABit) {
  const Balls balls = randomFoam(5000, .5, 4, 1, 31);
  const auto withThreads = [&](std::size_t threads) {
    tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return powerCellsOf(balls);
  };
  const FoamTopology alone = withThreads(1);
  for (std::size_t threads : {2, 4, 8}) expectSameBits(alone, withThreads(threads));
}

TEST(PowerCells, HistoryDoesNotChangeABit) {
  const Balls start = randomFoam(3000, .5, 4, 1, 41);
  Balls end = start;
  for (std::size_t i = 0; i < end.size(); ++i) {
    CounterRandom random(1, i, 4);
    const Vector3d unit(random.uniform() - .5, random.uniform() - .5, random.uniform());
    end.position[i] += .05 * end.radius[i] * unit;
    end.radius[i] *= 1 + .02 * random.uniform();
  }
  PowerCells used;
  FoamTopology out;
  used.compute(start.position, start.radius, start.id, out);
  used.compute(end.position, end.radius, end.id, out);
  expectSameBits(out, powerCellsOf(end));
}

TEST(PowerCells, CuttersCutAndAreNoBubbles) {
  /// Sums over some ten films, and the other ball of the pair cutting their discs.
  constexpr double kRoundOff = 1e-13;
  constexpr std::size_t kCutters = 120;
  const Balls balls = randomFoam(400, .5, 4, 1.2, 9);
  const std::size_t bubbles = balls.size() - kCutters;
  const FoamTopology all = powerCellsOf(balls);
  FoamTopology cut;
  PowerCells().compute(balls.position, balls.radius, balls.id, cut, kCutters);
  ASSERT_EQ(cut.volume.size(), bubbles);
  std::vector<std::pair<int, int>> expected, films;
  std::vector<double> filmArea(bubbles, 0);
  for (const Film& film : all.films)
    if (film.j < static_cast<int>(bubbles)) {
      expected.emplace_back(film.i, film.j);
      filmArea[film.i] += film.area, filmArea[film.j] += film.area;
    }
  for (const Film& film : cut.films) films.emplace_back(film.i, film.j);
  EXPECT_EQ(films, expected);
  for (std::size_t i = 0; i < bubbles; ++i) {
    const double r = balls.radius[i];
    EXPECT_NEAR(cut.volume[i], all.volume[i], kRoundOff * ballVolume(r));
    EXPECT_NEAR(cut.freeArea[i], all.freeArea[i], kRoundOff * 4 * std::numbers::pi * r * r);
    EXPECT_NEAR(cut.filmArea[i], filmArea[i], kRoundOff * 4 * std::numbers::pi * r * r);
    EXPECT_EQ(cut.hidden[i], all.hidden[i]);
  }
}

}  // namespace
}  // namespace spume::foam::test
