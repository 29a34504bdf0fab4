// Volumes corrected where a few cells are off, the rest left alone.
#include <gtest/gtest.h>

#include "foam/volume_patch.h"
#include "tests/support/foam_dense.h"

namespace spume::foam::test {
namespace {

/// Cells hold their gas to `tolerance`, with room to grow.
FoamParams heldTo(double tolerance) {
  FoamParams params;
  params.volumeMode = VolumeMode::newton, params.volumeTolerance = tolerance, params.radiusLimit = 10;
  return params;
}

/// The same pairs and films, areas and volumes to round-off of a sum over a dozen films.
void expectSameGeometry(const FoamTopology& a, const FoamTopology& b) {
  constexpr double kRoundOff = 1e-12;
  EXPECT_EQ(a.hidden, b.hidden);
  ASSERT_EQ(a.overlaps.size(), b.overlaps.size());
  ASSERT_EQ(a.films.size(), b.films.size());
  for (std::size_t p = 0; p < a.overlaps.size(); ++p)
    EXPECT_TRUE(a.overlaps[p].i == b.overlaps[p].i && a.overlaps[p].j == b.overlaps[p].j &&
                a.overlaps[p].film == b.overlaps[p].film);
  for (std::size_t f = 0; f < a.films.size(); ++f) {
    EXPECT_TRUE(a.films[f].i == b.films[f].i && a.films[f].j == b.films[f].j);
    EXPECT_NEAR(a.films[f].area, b.films[f].area, kRoundOff * std::pow(a.films[f].distance, 2));
  }
  for (std::size_t i = 0; i < a.volume.size(); ++i)
    EXPECT_NEAR(a.volume[i], b.volume[i], kRoundOff * b.volume[i]);
}

TEST(VolumePatch, CorrectsAFewCellsAndLeavesTheRest) {
  BubbleStore bubbles = denseFoam();
  const FoamParams params = heldTo(1e-6);
  const std::vector<double> before = bubbles.radius;
  const std::size_t odd = bubbles.size() / 2;
  bubbles.radius[odd] *= 1.1;
  FoamTopology topology, anew;
  Neighbours neighbours;
  measure(bubbles, topology, neighbours);
  const auto off = cellsOff(bubbles, params.volumeTolerance);
  EXPECT_GE(off.size(), 3u);
  EXPECT_LT(off.size(), bubbles.size() / 10);
  VolumePatch().settle(params, {}, topology, neighbours, bubbles);
  EXPECT_TRUE(cellsOff(bubbles, params.volumeTolerance).empty());
  PowerCells().compute(bubbles.position, bubbles.radius, bubbles.id, anew);
  expectSameGeometry(topology, anew);
  // The volumes and the radii that gave them are one to one: all come back, and those far off never left.
  std::size_t untouched = 0;
  for (std::size_t i = 0; i < bubbles.size(); ++i) {
    EXPECT_NEAR(bubbles.radius[i] / before[i], 1, 1e-4) << i;
    untouched += bubbles.radius[i] == before[i];
  }
  EXPECT_GT(untouched, bubbles.size() / 2);
}

/// Neighbours that hold their gas well enough beside the corrected cell stay as they are, to the bit.
TEST(VolumePatch, LeavesNeighboursThatStayWithinTheTolerance) {
  BubbleStore bubbles = denseFoam();
  const FoamParams params = heldTo(5e-3);
  const auto odd = static_cast<std::int32_t>(bubbles.size() / 2);
  bubbles.gas[odd] *= 1.02;
  FoamTopology topology;
  Neighbours neighbours;
  measure(bubbles, topology, neighbours);
  ASSERT_EQ(cellsOff(bubbles, params.volumeTolerance), std::vector{odd});
  const std::vector<double> before = bubbles.radius;
  VolumePatch().settle(params, {}, topology, neighbours, bubbles);
  EXPECT_TRUE(cellsOff(bubbles, params.volumeTolerance).empty());
  for (std::size_t i = 0; i < bubbles.size(); ++i)
    EXPECT_EQ(bubbles.radius[i] != before[i], i == static_cast<std::size_t>(odd)) << i;
}

/// A ball that grows until it meets one it did not touch before, which no patch around it holds.
TEST(VolumePatch, GrowsIntoAStrangerAndMeasuresItAlong) {
  FoamParams params;
  params.volumeMode = VolumeMode::newton;
  for (const double gap : {0.05e-3, 0.5e-3}) {
    BubbleStore bubbles;
    bubbles.add(bubbleAt({0, 0, 0}, 1e-3)), bubbles.add(bubbleAt({1.5e-3, 0, 0}, 1e-3));
    bubbles.add(bubbleAt({-2e-3 - gap, 0, 0}, 1e-3));
    bubbles.gas[0] *= 1.3;
    FoamTopology topology, anew;
    Neighbours neighbours;
    measure(bubbles, topology, neighbours);
    VolumePatch().settle(params, {}, topology, neighbours, bubbles);
    EXPECT_TRUE(cellsOff(bubbles, params.volumeTolerance).empty());
    EXPECT_EQ(topology.films.size(), gap < 0.2e-3 ? 2u : 1u);
    PowerCells().compute(bubbles.position, bubbles.radius, bubbles.id, anew);
    expectSameGeometry(topology, anew);
  }
}

}  // namespace
}  // namespace spume::foam::test
