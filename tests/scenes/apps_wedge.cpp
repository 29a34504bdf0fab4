#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "tests/support/apps_program.h"
#include "tests/support/pouring_scene.h"

namespace spume::apps::test {
namespace {

const std::string kVary = " --vary liquid.cfl=2,4 --vary foam.volume_mode=relax,newton ";
const char* const kFolders[] = {
    "liquid.cfl=2__foam.volume_mode=relax", "liquid.cfl=2__foam.volume_mode=newton",
    "liquid.cfl=4__foam.volume_mode=relax", "liquid.cfl=4__foam.volume_mode=newton"};

Outcome wedge(const Scratch& scratch, const std::string& arguments) {
  return runSpume("wedge " + scratch.write("pour.toml", kPour) + kVary + "--frames 3 -o " + (scratch / "w") +
                  arguments);
}

/// Runs a script of the sweep, as a shell does; what it prints goes to "said" of the scratch folder.
int runScript(const Scratch& scratch, const std::string& command) {
  const int status =
      std::system(("cd " + (scratch / "") + " && " + command + " >" + (scratch / "said") + " 2>&1").c_str());
  return WEXITSTATUS(status);
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

TEST(Wedge, CommandsRunEveryVariantAndGoOnWithWhatIsUnfinished) {
  const Scratch scratch;
  const Outcome outcome = wedge(scratch, "");
  ASSERT_EQ(outcome.code, 0) << outcome.errors;
  EXPECT_NE(outcome.output.find("4 variants"), std::string::npos) << outcome.output;
  const std::string table = contentsOf(scratch / "w/wedge.csv");
  EXPECT_EQ(table.rfind("folder,liquid.cfl,foam.volume_mode\n", 0), 0u);
  EXPECT_NE(table.find(std::string(kFolders[1]) + ",2,newton\n"), std::string::npos) << table;

  // Another run stands for one that was begun: the script goes on with it.
  const std::string begun = scratch / (std::string("w/") + kFolders[0]);
  ASSERT_EQ(runSpume("run " + begun + "/variant.toml --frames 1 -o " + begun).code, 0);
  ASSERT_EQ(runScript(scratch, "w/commands.sh"), 0) << contentsOf(scratch / "said");
  EXPECT_EQ(count(contentsOf(scratch / "said"), "going on from"), 1u);
  const std::string summary = contentsOf(scratch / "w/summary.csv");
  for (const char* folder : kFolders) {
    EXPECT_TRUE(std::filesystem::exists(scratch / ("w/" + std::string(folder) + "/run.json"))) << folder;
    EXPECT_NE(summary.find(std::string(folder) + ","), std::string::npos) << folder;
  }
  EXPECT_EQ(count(summary, ",done,3,"), 4u) << summary;
  ASSERT_EQ(runScript(scratch, "w/commands.sh"), 0);
  EXPECT_EQ(count(contentsOf(scratch / "said"), "nothing to do"), 4u);
}

TEST(Wedge, VariantsAreWhatTheCommandLineMakes) {
  const Scratch scratch;
  ASSERT_EQ(wedge(scratch, " --run").code, 0);
  const std::string one = scratch / "one", same = scratch / (std::string("w/") + kFolders[1]);
  ASSERT_EQ(runSpume("run " + (scratch / "pour.toml") +
                     " --frames 3 --set liquid.cfl=2 --set foam.volume_mode=newton -o " + one)
                .code,
            0);
  EXPECT_EQ(contentsOf(one + "/scene.toml"), contentsOf(same + "/variant.toml"));
  const std::string bubbles = contentsOf(one + "/bubbles/bubbles.0003.ply");
  EXPECT_FALSE(bubbles.empty());
  EXPECT_EQ(bubbles, contentsOf(same + "/bubbles/bubbles.0003.ply"));
}

TEST(Wedge, AVariantThatFailsDoesNotHoldUpTheOthers) {
  const Scratch scratch;
  ASSERT_EQ(wedge(scratch, "").code, 0);
  scratch.write(std::string("w/") + kFolders[1] + "/variant.toml", "[domain\n");
  EXPECT_EQ(runScript(scratch, "sh w/commands.sh --threads 1"), 2);
  EXPECT_NE(contentsOf(scratch / "said").find(std::string("failed: ") + kFolders[1] + "\n"),
            std::string::npos);
  const std::string summary = contentsOf(scratch / "w/summary.csv");
  EXPECT_EQ(count(summary, ",done,3,"), 3u) << summary;
  EXPECT_EQ(count(summary, ",not begun,0,"), 1u) << summary;
}

TEST(Wedge, TheEndOfTheTimeEndsTheScript) {
  const Scratch scratch;
  ASSERT_EQ(wedge(scratch, "").code, 0);
  EXPECT_EQ(runScript(scratch, "sh w/commands.sh --max-wall 0.001s"), 75);
  EXPECT_FALSE(std::filesystem::exists(scratch / ("w/" + std::string(kFolders[1]) + "/run.json")));
}

TEST(Wedge, ATaskOfTheJobArrayRunsItsVariantAndIsQueuedAgain) {
  const Scratch scratch;
  ASSERT_EQ(wedge(scratch, " --slurm --max-wall 1h30m --threads 2").code, 0);
  const std::string script = contentsOf(scratch / "w/wedge.sbatch");
  for (const char* line : {"#SBATCH --array=1-4\n", "#SBATCH --cpus-per-task=2\n",
                           "#SBATCH --time=01:40:00\n", "#SBATCH --requeue\n", "--max-wall 5400s\n"})
    EXPECT_NE(script.find(line), std::string::npos) << line << " is not in: " << script;

  std::filesystem::create_directories(scratch / "bin");
  scratch.write("bin/scontrol", "#!/bin/sh\necho \"$@\" >>" + (scratch / "queue") + "\n");
  std::filesystem::permissions(scratch / "bin/scontrol", std::filesystem::perms::owner_all);
  const std::string task = "PATH=" + (scratch / "bin") + ":$PATH SLURM_ARRAY_JOB_ID=7 SLURM_ARRAY_TASK_ID=";
  EXPECT_EQ(runScript(scratch, task + "2 sh w/wedge.sbatch"), 0) << contentsOf(scratch / "said");
  EXPECT_TRUE(std::filesystem::exists(scratch / ("w/" + std::string(kFolders[1]) + "/frames.csv")));
  EXPECT_FALSE(std::filesystem::exists(scratch / "queue"));

  scratch.write("hurried", std::string(script).replace(script.find("5400s"), 5, "0.001s"));
  EXPECT_EQ(runScript(scratch, task + "3 sh hurried"), 75);
  EXPECT_EQ(contentsOf(scratch / "queue"), "requeue 7_3\n");
  EXPECT_EQ(runScript(scratch, task + "9 sh w/wedge.sbatch"), 2);
}

}  // namespace
}  // namespace spume::apps::test
