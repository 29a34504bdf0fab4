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

TEST(TradeFaults, ALongerRunStandsForNoShorterOne) {
  const Scratch scratch;
  const std::string command = "trade " + scratch.write("pour.toml", kPour) + " --seeds 2 --dials dirt -o " +
                              (scratch / "t") + " --runs " + (scratch / "runs");
  ASSERT_EQ(runSpume(command + " --frames 2").code, 0);
  const std::string page = contentsOf(scratch / "t/trade_pour.md");
  const Outcome shorter = runSpume(command + " --frames 1");
  expectRefused(shorter, 2, scratch / "runs/pour/seed=1: holds a run of 2 frames");
  expectRefused(shorter, 2, "--frames 2");
  EXPECT_EQ(contentsOf(scratch / "t/trade_pour.md"), page);
  EXPECT_EQ(runSpume(command + " --frames 2").code, 0) << "it is as it was";
}

TEST(TradeFaults, FiguresAreNotTakenFromNothing) {
  const Scratch scratch;
  expectRefused(runSpume("trade " + scratch.write("pour.toml", kPour) +
                         " --frames 2 --seeds 2 --dials dirt --set output.every=3 -o " + (scratch / "t") +
                         " --runs " + (scratch / "runs")),
                2, "output.every = 3");
  EXPECT_FALSE(std::filesystem::exists(scratch / "t"));
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
