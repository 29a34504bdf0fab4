#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/apps_program.h"
#include "tests/support/pouring_scene.h"

namespace spume::apps::test {
namespace {

/// The sweep's folder is "w" in the scratch folder.
Outcome wedge(const Scratch& scratch, const std::string& arguments) {
  return runSpume("wedge " + scratch.write("pour.toml", kPour) + " -o " + (scratch / "w") + " " + arguments);
}

TEST(WedgeFaults, WrongUseIsRefused) {
  expectRefused(runSpume("wedge"), 2, "scene");
  expectRefused(runSpume("wedge x.toml"), 2, "--vary");
  expectRefused(runSpume("wedge x.toml --vary a.b=1 --max-wall 3h"), 2, "--slurm");
  expectRefused(runSpume("wedge x.toml --summary y"), 2, "--summary");
  expectRefused(runSpume("wedge /nonexistent/a.toml --vary a.b=1"), 4, "/nonexistent/a.toml");
  expectRefused(runSpume("wedge --summary /nonexistent"), 4, "/nonexistent/wedge.csv");
}

TEST(WedgeFaults, ABadVariantNamesItsArgumentAndNothingIsWritten) {
  const Scratch scratch;
  for (const auto& [vary, part] :
       {std::pair{"liquid.cfl=2,40", "--vary liquid.cfl=40: liquid.cfl = 40"},
        {"liquid.clf=2", "liquid.cfl"},
        {"foam.volume_mode=relax,newtno", "--vary foam.volume_mode=newtno"},
        {"liquid.cfl=2,[4", "--vary liquid.cfl=2,[4: "},
        {"time.max_step=0.02,0.001", "--vary time.max_step=0.001: time.min_step = 0.005 exceeds"},
        {"domain.size=[0.01,0.01,0.01]", "; with --vary domain.size=[0.01,0.01,0.01]"},
        {"inflow.0.centre=[0.03,0.05,0.03],[9,9,9]", "--vary inflow.0.centre=[9,9,9]"},
        {"inflow.1.radius=0.01", "--vary inflow.1.radius=0.01"}}) {
    expectRefused(wedge(scratch, std::string("--vary '") + vary + "'"), 2, part);
    EXPECT_FALSE(std::filesystem::exists(scratch / "w")) << vary;
  }
}

TEST(WedgeFaults, AKeyGivenTwiceIsRefused) {
  const Scratch scratch;
  expectRefused(wedge(scratch, "--vary liquid.cfl=1,2 --vary liquid.cfl=3"), 2, "--vary liquid.cfl=3");
  expectRefused(wedge(scratch, "--vary liquid.cfl=1,2 --set liquid.cfl=3"), 2, "--set liquid.cfl=3");
  expectRefused(wedge(scratch, "--vary domain.resolution=16,20 --resolution 20"), 2, "domain.resolution");
  expectRefused(wedge(scratch, "--vary domain.resolution=16,20 --quality draft"), 2, "--quality draft");
}

TEST(WedgeFaults, FilesOfOthersAreKept) {
  const Scratch scratch;
  std::filesystem::create_directories(scratch / "w");
  const std::string script = scratch.write("w/commands.sh", "mine\n");
  expectRefused(wedge(scratch, "--vary liquid.cfl=1,2"), 4, "commands.sh: no sweep wrote");
  EXPECT_EQ(contentsOf(script), "mine\n");
  EXPECT_FALSE(std::filesystem::exists(scratch / "w/wedge.csv"));
}

TEST(WedgeFaults, TablesOfOthersAreKept) {
  for (const char* table : {"wedge.csv", "summary.csv"}) {
    const Scratch scratch;
    std::filesystem::create_directories(scratch / "w");
    const std::string contents = "owner,folder,size\nme,a,1\n";  // "folder" is a common word in a table
    const std::string path = scratch.write(std::string("w/") + table, contents);
    expectRefused(wedge(scratch, "--vary liquid.cfl=1,2"), 4, std::string(table) + ": no sweep wrote");
    EXPECT_FALSE(std::filesystem::exists(scratch / "w/commands.sh")) << table;
    EXPECT_EQ(contentsOf(path), contents);
  }
}

TEST(WedgeFaults, ASummaryOfAnotherIsKept) {
  const Scratch scratch;
  ASSERT_EQ(wedge(scratch, "--vary liquid.cfl=1,2").code, 0);
  const std::string path = scratch.write("w/summary.csv", "mine\n");
  expectRefused(runSpume("wedge --summary " + (scratch / "w")), 4, "summary.csv: no sweep wrote");
  EXPECT_EQ(contentsOf(path), "mine\n");
}

TEST(WedgeFaults, ARunOfAnotherSceneIsKept) {
  const Scratch scratch;
  ASSERT_EQ(wedge(scratch, "--vary liquid.cfl=2 --frames 1 --run").code, 0);
  const std::string before = contentsOf(scratch / "w/liquid.cfl=2/variant.toml");
  expectRefused(wedge(scratch, "--vary liquid.cfl=2 --frames 1 --set foam.wetness=0.9"), 2, "foam.wetness");
  EXPECT_EQ(contentsOf(scratch / "w/liquid.cfl=2/variant.toml"), before);
  EXPECT_EQ(wedge(scratch, "--vary liquid.cfl=2,3 --frames 2").code, 0) << "longer, and with more values";
}

TEST(WedgeFaults, ATableThatIsNoSweepsIsRefused) {
  const Scratch scratch;
  scratch.write("wedge.csv", "a,b\n1,2\n");
  expectRefused(runSpume("wedge --summary " + (scratch / "")), 2, "is not the table of a sweep");
}

}  // namespace
}  // namespace spume::apps::test
