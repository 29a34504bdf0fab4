// Clusters of dry bubbles and lone bubbles: what `spume reproduce foam` runs of them reaches its aims
// (accuracy, 3.1 and 4.1: B1, G1, G2).
#include <gtest/gtest.h>

#include <algorithm>

#include "apps/reproduce/dry_cluster.h"
#include "apps/reproduce/foam_studies.h"

namespace spume::apps {
namespace {

/// Runs one of `studies` and expects every aim to be met, and `aims` of them.
void expectMet(const std::vector<Study>& studies, const std::string& key, std::ptrdiff_t aims) {
  const auto study =
      std::find_if(studies.begin(), studies.end(), [&](const Study& s) { return s.key == key; });
  ASSERT_NE(study, studies.end()) << key;
  const std::vector<ResultRow> rows = study->run({});
  EXPECT_EQ(std::count_if(rows.begin(), rows.end(), [](const ResultRow& r) { return !r.aim.empty(); }), aims);
  for (const ResultRow& row : rows) EXPECT_NE(row.verdict, Verdict::missed) << summaryOf(row);
}

TEST(Cluster, EqualBubblesRestAtTheExactSizesAndDistances) { expectMet(clusterStudies(), "G1", 12); }

TEST(Cluster, UnequalPairRestsAtTheModelsFixedPoint) { expectMet(clusterStudies(), "G2", 1); }

/// Of 17 diameters in contaminated and in clean water, and how much steps of 1 to 20 ms differ.
TEST(LoneBubble, TerminalSpeedIsTheTabulatedOneForEverySizeAndStep) {
  expectMet(loneBubbleStudies(), "B1", 35);
}

TEST(Cluster, WetPairsRestAtTheLengthOfTheirWetness) {
  const double wetness[] = {0, .2, .4, .6, .8, 1}, length[] = {1.0, 1.2649, 1.4832, 1.6733, 1.8439, 2};
  const double cellShare[] = {.84375, .91110, .95424, .98108, .99555, 1};  // accuracy, 4.1
  for (std::size_t k = 0; k < std::size(wetness); ++k) {
    foam::FoamParams params = dryFoam();
    params.wetness = params.wetnessAloft = wetness[k];
    params.volumeRate = 0;
    foam::FoamSolver solver(params);
    foam::BubbleStore bubbles;
    for (const double x : {0.0, 0.9e-3})
      bubbles.add({.position = {x, 0, 0}, .radius = 1e-3, .type = foam::BubbleClass::air});
    const foam::StillPool space = emptySpace();
    for (int step = 0; step < 2000; ++step) solver.step(bubbles, space, 0.005);
    EXPECT_NEAR((bubbles.position[0] - bubbles.position[1]).norm() / 1e-3, length[k], 1e-4);
    EXPECT_NEAR(bubbles.volume[0] / bubbles.gas[0], cellShare[k], 1e-4);
  }
}

}  // namespace
}  // namespace spume::apps
