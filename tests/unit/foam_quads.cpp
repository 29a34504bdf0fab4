// Quads and the blocks that act on them, against Eigen.
#include <gtest/gtest.h>

#include <cfloat>

#include "foam/counter_random.h"
#include "foam/flush_tiny.h"
#include "foam/symmetric_block.h"

namespace spume::foam {
namespace {

using Eigen::Vector4f;

Vector4f drawn(std::uint64_t seed) {
  CounterRandom random(21, seed, 0);
  Vector4f v;
  for (int k = 0; k < 4; ++k) v[k] = static_cast<float>(2 * random.uniform() - 1);
  return v;
}

std::vector<Vector4f> drawnList(std::size_t count) {
  std::vector<Vector4f> list;
  for (std::size_t k = 0; k < count; ++k) list.push_back(drawn(k));
  return list;
}

constexpr float kRoundOff = 4 * FLT_EPSILON;  // a handful of operations on numbers up to 1

TEST(Quads, GatherMaskAndJoinAsTheirSumsSay) {
  const std::vector<Vector4f> list = drawnList(12);
  const std::int32_t place[4] = {7, 0, 11, 3};
  for (std::int32_t count = 1; count <= static_cast<std::int32_t>(kQuads) + 1; ++count) {
    Vector4f expected = Vector4f::Zero();
    for (std::int32_t k = 0; k < std::min<std::int32_t>(count, kQuads); ++k) expected += list[place[k]];
    const Vector4f joined = toVector(joinQuads(firstQuads(gatherQuads(list.data(), place), count)));
    EXPECT_LE((joined - expected).norm(), kRoundOff) << count;
  }
}

TEST(Quads, SumsAndFourthsStayWithinTheirQuad) {
  const std::vector<Vector4f> list = drawnList(kQuads);
  const QuadLanes sums = sumsOf(loadQuads(list.data())), fourths = fourthsOf(loadQuads(list.data()));
  for (std::size_t lane = 0; lane < 4 * kQuads; ++lane) {
    EXPECT_NEAR(sums[lane], list[lane / 4].sum(), kRoundOff);
    EXPECT_EQ(fourths[lane], list[lane / 4][3]);
  }
}

TEST(Quads, BlocksActAsTheirMatrices) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Vector4f a = drawn(3 * seed), b = drawn(3 * seed + 1), x = drawn(3 * seed + 2);
    Eigen::Matrix3d lower;
    lower << a[0], 0, 0, a[1], a[2], 0, a[3], b[0], b[1];
    const Eigen::Matrix3d symmetric = lower + lower.transpose();
    const Eigen::Vector3d v = x.head<3>().cast<double>();
    const auto expectNear = [&](const Quad& found, const Eigen::Vector3d& expected) {
      EXPECT_LE((toVector(found).head<3>().cast<double>() - expected).norm(), kRoundOff);
      EXPECT_EQ(found[3], 0);
    };
    const TriangularBlock triangular(lower);
    expectNear(triangular.times(loadQuad(x)), lower * v);
    expectNear(triangular.transposedTimes(loadQuad(x)), lower.transpose() * v);
    const Vector4f x0(x[0], x[1], x[2], 0);
    const SymmetricBlock blocks[] = {SymmetricBlock(symmetric), SymmetricBlock(0.5 * symmetric)};
    expectNear(blocks[0].times(loadQuad(x0)), symmetric * v);
    const std::vector<Vector4f> list(kQuads, x0);
    const auto sum = [&](std::int32_t count) {
      return joinQuads(timesQuads(blocks, count, loadQuads(list.data())));
    };
    expectNear(sum(1), symmetric * v);
    expectNear(sum(2), (kQuads > 1 ? 1.5 : 1) * (symmetric * v));
    EXPECT_LE((triangular.matrix() - lower).norm(), kRoundOff);
    EXPECT_LE((lower * triangular.solve(v) - v).norm(), kRoundOff * triangular.solve(v).norm());
  }
}

TEST(FlushTiny, TinyNumbersAreZeroWhileItLives) {
  const volatile float least = FLT_MIN;
  {
    const FlushTiny flush;
    EXPECT_EQ(least * 0.25f * 4e30f, 0.0f);
  }
  EXPECT_GT(least * 0.25f * 4e30f, 0.0f);
}

}  // namespace
}  // namespace spume::foam
