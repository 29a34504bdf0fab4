#include <gtest/gtest.h>

#include <numbers>
#include <numeric>

#include "foam/disc_lines.h"
#include "tests/support/foam_balls.h"

namespace spume::foam::test {
namespace {

constexpr double kRadius = 1;

/// Planes all around the ball, the nearest at its centre, the farthest beyond it.
CuttingPlanes planesAround(std::size_t count) {
  CuttingPlanes planes;
  planes.resize(count);
  for (std::size_t k = 0; k < count; ++k) {
    CounterRandom random(3, k, 5);
    const double z = 2 * random.uniform() - 1, turn = 2 * std::numbers::pi * random.uniform();
    planes.nx[k] = std::sqrt(1 - z * z) * std::cos(turn),
    planes.ny[k] = std::sqrt(1 - z * z) * std::sin(turn);
    planes.nz[k] = z, planes.height[k] = 1.1 * random.uniform(),
    planes.heightShift[k] = 1e-9 * random.uniform();
  }
  return planes;
}

/// What is left of one of the discs that have been found and scaled.
std::vector<double> edgesOf(const DiscLines& lines, std::size_t disc) {
  FilmEdges edges;
  const DiscLines::Rest rest = lines.clip(disc, edges);
  std::vector<double> found = {lines.discRadius2(disc), double(rest.any), double(rest.centreInside),
                               double(rest.closed)};
  for (const auto* column : {&edges.offset, &edges.shift, &edges.t1, &edges.t2})
    found.insert(found.end(), column->begin(), column->begin() + static_cast<std::ptrdiff_t>(edges.count));
  return found;
}

TEST(DiscLines, DiscsCutTogetherAreThoseCutAlone) {
  for (const std::size_t count : {1u, 5u, 9u, 30u}) {
    const CuttingPlanes planes = planesAround(count);
    std::vector<std::int32_t> faces(count);
    std::iota(faces.rbegin(), faces.rend(), 0);
    DiscLines together, alone;
    together.find(planes, faces, kRadius);
    together.scale();
    std::size_t left = 0;
    for (std::size_t disc = 0; disc < count; ++disc) {
      alone.find(planes, {&faces[disc], 1}, kRadius);
      ASSERT_EQ(together.isLeft(disc), alone.isLeft(0));
      if (!together.isLeft(disc)) continue;
      alone.scale();
      EXPECT_EQ(edgesOf(together, disc), edgesOf(alone, 0));
      ++left;
    }
    EXPECT_GT(left, count / 4);
  }
}

TEST(DiscLines, APlaneBeyondTheBallHasNoDiscAndOneBeforeItTakesAll) {
  CuttingPlanes planes;
  planes.resize(2);
  planes.nx = {0, 0}, planes.ny = {0, 0}, planes.nz = {1, 1}, planes.height = {1.5, 0.5};
  for (auto* column : {&planes.nx, &planes.ny, &planes.nz, &planes.height})
    column->resize(planes.heightShift.size());
  const std::int32_t faces[] = {0, 1};
  DiscLines lines;
  lines.find(planes, faces, kRadius);
  EXPECT_FALSE(lines.isLeft(0));
  EXPECT_TRUE(lines.isLeft(1));
  planes.height[0] = 0.8;
  lines.find(planes, faces, kRadius);
  EXPECT_FALSE(lines.isLeft(0));
  EXPECT_TRUE(lines.isLeft(1));
}

}  // namespace
}  // namespace spume::foam::test
