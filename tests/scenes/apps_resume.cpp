#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>
#include <vector>

#include "coupling/bubble_table.h"
#include "tests/support/apps_program.h"
#include "tests/support/pouring_scene.h"

namespace spume::apps::test {
namespace {

/// The file without its columns of wall time.
std::string withoutSeconds(const std::string& csv) {
  std::istringstream lines(contentsOf(csv));
  std::string line, cell, kept;
  std::vector<bool> counts;
  while (std::getline(lines, line)) {
    std::istringstream cells(line);
    const bool isHeader = counts.empty();
    for (std::size_t n = 0; std::getline(cells, cell, ','); ++n) {
      if (isHeader) counts.push_back(cell.rfind("seconds", 0) != 0);
      if (counts.at(n)) kept += cell + ",";
    }
    kept += '\n';
  }
  return kept;
}

/// Exact copies of both runs' last frame and of everything that happened on the way.
void expectSameRun(const std::string& a, const std::string& b) {
  for (const char* file :
       {"/liquid/liquid.0006.vdb", "/bubbles/bubbles.0006.vdb", "/bubbles/bubbles.0006.ply", "/events.csv"}) {
    ASSERT_FALSE(contentsOf(a + file).empty()) << file;
    EXPECT_EQ(contentsOf(a + file), contentsOf(b + file)) << file;
  }
  for (const char* file : {"/frames.csv", "/steps.csv"})
    EXPECT_EQ(withoutSeconds(a + file), withoutSeconds(b + file)) << file;
}

TEST(Resume, EqualsAnUninterruptedRun) {
  const Scratch scratch;
  const std::string scene = scratch.write("pour.toml", kPour), a = scratch / "a", b = scratch / "b";
  ASSERT_EQ(runSpume("run " + scene + " --frames 6 -o " + a).code, 0);
  ASSERT_EQ(runSpume("run " + scene + " --frames 3 --threads 1 -o " + b).code, 0);
  ASSERT_EQ(runSpume("run " + scene + " --frames 6 --threads 3 -o " + b).code, 0);
  expectSameRun(a, b);
}

TEST(Resume, GoesOnFromTheMiddleOfAFrame) {
  const Scratch scratch;
  const std::string scene = scratch.write("pour.toml", kPour), a = scratch / "a", b = scratch / "b";
  ASSERT_EQ(runSpume("run " + scene + " --frames 6 -o " + a).code, 0);
  const Outcome stopped = runSpume("run " + scene + " --frames 6 --restart --max-wall 0.001s -o " + b);
  ASSERT_EQ(stopped.code, 75);
  EXPECT_NE(stopped.output.find("the same command without --restart goes on"), std::string::npos)
      << stopped.output;
  ASSERT_EQ(runSpume("run " + scene + " --frames 6 -o " + b).code, 0);
  expectSameRun(a, b);
}

/// Two bubbles at rest in still water, and a source.
const std::string kListed = R"([domain]
size = [0.08, 0.08, 0.08]
resolution = 16
[time]
frames = 2
[still_pool]
enabled = true
level = 0.06
[coupling.entrainment]
enabled = false
[foam]
wetness_law = "per_bubble"
bursting = false
[[bubbles]]
file = "balls.csv"
[[bubble_source]]
shape = "sphere"
centre = [0.04, 0.02, 0.04]
radius = 0.01
rate = 48
radius_law = "uniform"
min_radius = 1e-3
max_radius = 1.5e-3
[output]
preview = false
)";

TEST(Resume, KeepsIdsAndWetnessOfAFileAndNumbersBirthsOn) {
  const Scratch scratch;
  const std::string scene = scratch.write("listed.toml", kListed), a = scratch / "a", b = scratch / "b";
  scratch.write("balls.csv",
                "id,x,y,z,r,wetness\n70,0.02,0.04,0.04,0.002,0.25\n50,0.06,0.04,0.04,0.002,0.875\n");
  ASSERT_EQ(runSpume("run " + scene + " -o " + a).code, 0);
  ASSERT_EQ(runSpume("run " + scene + " --frames 1 -o " + b).code, 0);
  ASSERT_EQ(runSpume("run " + scene + " -o " + b).code, 0);
  const std::string last = "/bubbles/bubbles.0002.ply";
  EXPECT_EQ(contentsOf(a + last), contentsOf(b + last));
  const coupling::BubbleTable bubbles = coupling::readBubbleTable(b + last);
  ASSERT_EQ(bubbles.id, (std::vector<std::uint64_t>{50, 70, 71, 72, 73}));  // 48 a second for 1/15 s
  EXPECT_EQ(bubbles.wetness[0], 0.875);
  EXPECT_EQ(bubbles.wetness[1], 0.25);
}

TEST(Resume, AnotherSceneIsRefusedAndTheRunKept) {
  const Scratch scratch;
  const std::string scene = scratch.write("pour.toml", kPour), folder = scratch / "a";
  ASSERT_EQ(runSpume("run " + scene + " --frames 2 -o " + folder).code, 0);
  const std::string before = contentsOf(folder + "/events.csv");
  expectRefused(runSpume("run " + scene + " --frames 2 --set foam.wetness=0.9 -o " + folder), 2,
                "foam.wetness");
  EXPECT_EQ(contentsOf(folder + "/events.csv"), before);
  EXPECT_EQ(runSpume("run " + scene + " --frames 2 --set foam.wetness=0.9 --restart -o " + folder).code, 0);
}

}  // namespace
}  // namespace spume::apps::test
