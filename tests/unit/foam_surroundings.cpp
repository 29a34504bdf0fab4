// What is sampled at the bubbles.
#include <gtest/gtest.h>

#include "foam/surroundings.h"
#include "tests/foam_fixtures.h"

namespace spume::foam::test {
namespace {

TEST(Surroundings, TheFlowAloneIsThatOfAllThatIsSampled) {
  const FoamParams params = makePreset(Preset::physical);
  BubbleStore bubbles;
  for (int n = 0; n < 5; ++n) bubbles.add(bubbleAt({1e-3 * n, -2e-3 + 1e-3 * n, 0}, 1e-3));
  Surroundings all, flow;
  all.sample(openPool(params), bubbles.positions());
  flow.sampleFlow(openPool(params), bubbles.positions());
  EXPECT_EQ(flow.phi, all.phi);
  EXPECT_EQ(flow.liquidVelocity, all.liquidVelocity);
  EXPECT_LT(flow.phi[0], 0);
  EXPECT_EQ(flow.psi.size(), 0) << "solids are left out";
}

}  // namespace
}  // namespace spume::foam::test
