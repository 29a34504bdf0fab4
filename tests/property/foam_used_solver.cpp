// A solver holds scratch memory between steps and no state: whatever it has stepped before, larger foams or
// smaller ones, it steps as a new one does, to the last bit.
#include <gtest/gtest.h>

#include <cstring>

#include "foam/foam_solver.h"
#include "tests/support/floating_foam.h"

namespace spume::foam::test {
namespace {

constexpr double kDt = 5e-3;

/// Numbers of bubbles on both sides of what changes a step's ways: 6144 rows for clusters, 512 a block, one,
/// none.
constexpr int kSizes[] = {9000, 6143, 6144, 1030, 500, 30, 2, 1, 0, 7000, 3, 6150, 6100};

/// The first `count` bubbles along the curve through space, which lie together.
BubbleStore firstOf(const BubbleStore& all, int count) {
  std::vector<std::int32_t> rows;
  for (std::int32_t i = 0; i < count; ++i) rows.push_back(i);
  BubbleStore some;
  some.gather(all, rows);
  for (std::size_t i = 0; i < some.size(); ++i) some.id[i] = i;
  some.nextId = some.size();
  return some;
}

template <typename T>
void expectSameBits(const std::vector<T>& a, const std::vector<T>& b, const char* what, int count) {
  ASSERT_EQ(a.size(), b.size()) << what << " of " << count;
  EXPECT_TRUE(a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0)
      << what << " of " << count;
}

class UsedSolver : public testing::Test {
 protected:
  FloatingFoam foam = FloatingFoam(9000, 0.4);
  BubbleStore all = inSpaceOrder(foam.bubbles);
  StillPool pool = StillPool(foam.box);

  void expectNoTrace(const FoamParams& params) const {
    FoamSolver used(params);
    for (const int count : kSizes) {
      BubbleStore bubbles = firstOf(all, count), expected = bubbles;
      FoamSolver fresh(params);
      fresh.step(expected, pool, kDt);
      used.step(bubbles, pool, kDt);
      expectSameBits(bubbles.id, expected.id, "id", count);
      expectSameBits(bubbles.position, expected.position, "position", count);
      expectSameBits(bubbles.velocity, expected.velocity, "velocity", count);
      expectSameBits(bubbles.radius, expected.radius, "radius", count);
      expectSameBits(bubbles.volume, expected.volume, "volume", count);
      expectSameBits(bubbles.exposure, expected.exposure, "exposure", count);
      EXPECT_EQ(used.stableDt(bubbles), fresh.stableDt(expected)) << count;
      EXPECT_EQ(used.dragImpulses().size(), fresh.dragImpulses().size()) << count;
    }
  }
};

TEST_F(UsedSolver, StepsLikeANewOne) { expectNoTrace(foam.params); }

TEST_F(UsedSolver, StepsLikeANewOneWhereItHoldsVolumesAndBubblesBurst) {
  FoamParams params = foam.params;
  params.volumeMode = VolumeMode::newton, params.volumeTolerance = 5e-3, params.bursting = true;
  expectNoTrace(params);
}

TEST_F(UsedSolver, StepsLikeANewOneWhereItMovesBorders) {
  FoamParams params = foam.params;
  params.borderRate = 2, params.attractionLaw = AttractionLaw::none;
  expectNoTrace(params);
}

TEST_F(UsedSolver, StepsLikeANewOneByJacobi) {
  FoamParams params = foam.params;
  params.solver = LinearSolver::pcgJacobi;
  expectNoTrace(params);
}

}  // namespace
}  // namespace spume::foam::test
