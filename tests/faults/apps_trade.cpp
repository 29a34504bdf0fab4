#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/apps_program.h"
#include "tests/support/pouring_scene.h"

namespace spume::apps::test {
namespace {

TEST(TradeFaults, WrongUseIsRefused) {
  const Scratch scratch;
  const std::string scene = scratch.write("pour.toml", kPour), out = " --frames 1 -o " + (scratch / "t");
  expectRefused(runSpume("trade /nonexistent/a.toml"), 4, "/nonexistent/a.toml");
  expectRefused(runSpume("trade " + scene + out + " --dials clf"), 2, "did you mean cfl?");
  expectRefused(runSpume("trade " + scene + out + " --dials borders"), 2, "no dial of this scene");
  expectRefused(runSpume("trade " + scene + out + " --seeds 1"), 2, "--seeds");
  expectRefused(runSpume("trade " + scene + out + " --set liquid.cfl=40"), 2, "liquid.cfl");
  EXPECT_FALSE(std::filesystem::exists(scratch / "t"));
}

TEST(TradeFaults, UnwritableRunsAreAnOutputError) {
  const Scratch scratch;
  expectRefused(runSpume("trade " + scratch.write("pour.toml", kPour) + " --frames 1 --runs /proc/nothing"),
                4, "/proc/nothing");
}

TEST(TradeFaults, ListRunsNothing) {
  const Scratch scratch;
  const Outcome outcome =
      runSpume("trade " + scratch.write("pour.toml", kPour) + " --list --runs /proc/nothing");
  EXPECT_EQ(outcome.code, 0) << outcome.errors;
  EXPECT_NE(outcome.output.find("cfl: CFL number: 8 4 2 1\n"), std::string::npos) << outcome.output;
}

}  // namespace
}  // namespace spume::apps::test
