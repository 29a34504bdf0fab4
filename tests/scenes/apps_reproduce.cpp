#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/apps_program.h"

namespace spume::apps::test {
namespace {

/// The program on the scenes of the project, with results and runs in a folder of the test.
Outcome reproduce(const Scratch& scratch, const std::string& arguments) {
  return runSpume("reproduce " + arguments + " --scenes " SPUME_SOURCE_DIR "/data/scenes -o " +
                  (scratch / "results") + " --runs " + (scratch / "runs"));
}

TEST(Reproduce, ShortClusterWritesTableCurvesPlotAndReport) {
  const Scratch scratch;
  const Outcome outcome = reproduce(scratch, "cluster --frames 12");
  ASSERT_EQ(outcome.code, 0) << outcome.errors;
  const std::string results = scratch / "results";
  const std::string report = contentsOf(results + "/reproduce.md");
  for (const char* part : {"The paper's scenes beside ours", "12 frames", "25 % [Busaryev 2012]",
                           "without correction", "scenes/cluster_volume.svg"})
    EXPECT_NE(report.find(part), std::string::npos) << part << " is not in: " << report;
  EXPECT_EQ(contentsOf(results + "/scenes/cluster_volume.svg").rfind("<svg", 0), 0u);
  const std::string curves = contentsOf(results + "/scenes/cluster.csv");
  EXPECT_EQ(std::count(curves.begin(), curves.end(), '\n'), 13);  // a header and a row a frame
  EXPECT_FALSE(contentsOf(results + "/scenes.csv").empty());
}

TEST(Reproduce, GoesOnWithAShorterRunAndKeepsOtherRows) {
  const Scratch scratch;
  ASSERT_EQ(reproduce(scratch, "soap --frames 2").code, 0);
  ASSERT_EQ(reproduce(scratch, "cluster --frames 2").code, 0);
  const Outcome outcome = reproduce(scratch, "cluster --frames 4");
  ASSERT_EQ(outcome.code, 0) << outcome.errors;
  EXPECT_NE(outcome.output.find("going on from"), std::string::npos) << outcome.output;
  const std::string table = contentsOf((scratch / "results") + "/scenes.md");
  EXPECT_NE(table.find("cluster equal bubbles between two plates | 4 frames"), std::string::npos) << table;
  EXPECT_NE(table.find("soap froth in a glass box | 2 frames"), std::string::npos) << table;
}

}  // namespace
}  // namespace spume::apps::test
