#include <gtest/gtest.h>

#include "tests/support/apps_program.h"

namespace spume::apps::test {
namespace {

TEST(ReproduceFaults, UnknownTableOrCaseNamesTheNearest) {
  expectRefused(runSpume("reproduce cokes"), 2, "did you mean coke?");
  expectRefused(runSpume("reproduce scenes --cases sope"), 2, "did you mean soap?");
  expectRefused(runSpume("reproduce"), 2, "tables");
  expectRefused(runSpume("reproduce soap --frames 0"), 2, "--frames");
}

TEST(ReproduceFaults, MissingSceneIsAnInputError) {
  const Scratch scratch;
  expectRefused(runSpume("reproduce cluster --scenes /nonexistent -o " + (scratch / "results")), 4,
                "/nonexistent/cluster.toml");
}

TEST(ReproduceFaults, ALongerRunStandsForNoShorterOne) {
  const Scratch scratch;
  const std::string command = "reproduce cluster --scenes " SPUME_SOURCE_DIR "/data/scenes -o " +
                              (scratch / "results") + " --runs " + (scratch / "runs") + " --frames ";
  ASSERT_EQ(runSpume(command + "2").code, 0);
  expectRefused(runSpume(command + "1"), 2, scratch / "runs/cluster: holds a run of 2 frames");
}

TEST(ReproduceFaults, UnwritableOutputIsAnOutputError) {
  expectRefused(runSpume("reproduce cluster -o /proc/nothing"), 4, "/proc/nothing");
}

TEST(ReproduceFaults, AnotherFileInPlaceOfTheTableIsRefusedAndKept) {
  const Scratch scratch;
  const std::string table = scratch.write("scenes.csv", "a,b\n1,2\n");
  expectRefused(runSpume("reproduce cluster -o " + (scratch / "")), 2, "is not a table of results");
  EXPECT_EQ(contentsOf(table), "a,b\n1,2\n");
}

}  // namespace
}  // namespace spume::apps::test
