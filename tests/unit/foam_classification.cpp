// Labels and the surface weight against closed areas.
#include <gtest/gtest.h>

#include "foam/classification.h"
#include "foam/power_cells.h"
#include "tests/foam_fixtures.h"

namespace spume::foam::test {
namespace {

/// Weights of bubbles in a pool whose surface is y = 0.
std::vector<double> weights(BubbleStore& bubbles) {
  FoamTopology topology;
  PowerCells().compute(bubbles.position, bubbles.radius, bubbles.id, topology);
  Neighbours neighbours;
  neighbours.build(bubbles.size(), topology.overlaps);
  Surroundings around;
  around.sample(openPool(makePreset(Preset::physical)), bubbles.positions());
  weighSurface(around, topology, neighbours, bubbles);
  return bubbles.surfaceWeight;
}

TEST(Classification, LabelsFollowPhi) {
  EXPECT_EQ(classify(-1.1e-3, 1e-3, 1), BubbleClass::liquid);
  EXPECT_EQ(classify(-0.9e-3, 1e-3, 1), BubbleClass::surface);
  EXPECT_EQ(classify(0.9e-3, 1e-3, 0.2), BubbleClass::surface);
  EXPECT_EQ(classify(0.9e-3, 1e-3, 0), BubbleClass::air);  // the liquid does not reach it
  EXPECT_EQ(classify(1.1e-3, 1e-3, 1), BubbleClass::air);
}

TEST(Classification, LabelIsKeptWithinAMargin) {
  EXPECT_EQ(reclassify(BubbleClass::liquid, -0.9e-3, 1e-3, 1), BubbleClass::liquid);
  EXPECT_EQ(reclassify(BubbleClass::liquid, -0.7e-3, 1e-3, 1), BubbleClass::surface);
  EXPECT_EQ(reclassify(BubbleClass::surface, -0.9e-3, 1e-3, 1), BubbleClass::surface);
  EXPECT_EQ(reclassify(BubbleClass::surface, -1.1e-3, 1e-3, 1), BubbleClass::liquid);
  EXPECT_EQ(reclassify(BubbleClass::air, 0.5e-3, 1e-3, 0.7), BubbleClass::air);
  EXPECT_EQ(reclassify(BubbleClass::air, 0.5e-3, 1e-3, 1), BubbleClass::surface);
  EXPECT_EQ(reclassify(BubbleClass::surface, 1.1e-3, 1e-3, 0), BubbleClass::surface);
  EXPECT_EQ(reclassify(BubbleClass::surface, 1.3e-3, 1e-3, 0), BubbleClass::air);
  EXPECT_EQ(reclassify(BubbleClass::surface, 0.5e-3, 1e-3, 0.3), BubbleClass::surface);
  EXPECT_EQ(reclassify(BubbleClass::surface, 0.5e-3, 1e-3, 0), BubbleClass::air);
}

TEST(Classification, ALoneBubbleIsHeldByItsWetCap) {
  BubbleStore bubbles;
  for (const double height : {-3.0, -0.5, 0.0, 0.7, 0.9, 0.99, 1.5})
    bubbles.add(bubbleAt({10 * height, height * 1e-3, 0}, 1e-3));
  const std::vector<double> w = weights(bubbles);
  const double expected[] = {1, 1, 1, 1, 0.5, 0.05, 0};  // wet share (1 - phi/r)/2 over 0.1
  for (std::size_t i = 0; i < w.size(); ++i) EXPECT_NEAR(w[i], expected[i], 1e-12) << i;
}

TEST(Classification, NeighboursCoverWhatTheyContain) {
  // A bubble at phi = 0.6 r has the wet share 0.2; a large one straight below covers the cap up to a chosen
  // circle.
  constexpr double kSampling = 0.02;  // 512 samples with linear ramps: second order in their spacing of 0.16
  const double r = 1e-3, level = 0.6, big = 3e-3;
  for (const double circle : {0.65, 0.7, 0.8, 0.9}) {  // -cosine of the covered cap's rim
    const double d = circle * r + std::sqrt(big * big - r * r * (1 - circle * circle));
    BubbleStore bubbles;
    bubbles.add(bubbleAt({0, level * r, 0}, r));
    bubbles.add(bubbleAt({0, level * r - d, 0}, big));
    const double uncovered = (1 - level) / 2 - (1 - circle) / 2;  // zone between the surface and the rim
    EXPECT_NEAR(weights(bubbles)[0], std::min(1.0, uncovered / kFullWetShare), kSampling / kFullWetShare)
        << circle;
  }
}

TEST(Classification, ABubbleInsideAnotherIsNotHeld) {
  BubbleStore bubbles;
  bubbles.add(bubbleAt({0, 0, 0}, 1e-3));
  bubbles.add(bubbleAt({0.2e-3, 0, 0}, 3e-3));
  const std::vector<double> w = weights(bubbles);
  EXPECT_EQ(w[0], 0);
  EXPECT_EQ(w[1], 1);
}

}  // namespace
}  // namespace spume::foam::test
