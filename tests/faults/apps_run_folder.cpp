// A run's folder: no frame is lost unasked, none is missing after a failure.
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/apps_program.h"
#include "tests/support/pouring_scene.h"

namespace spume::apps::test {
namespace {

namespace fs = std::filesystem;

/// kPour with a checkpoint every so many frames.
std::string pour(int checkpointEvery) {
  std::string text = kPour;
  const std::string every = "checkpoint_every = 2";
  return text.replace(text.find(every), every.size(),
                      "checkpoint_every = " + std::to_string(checkpointEvery));
}

class RunFolder : public testing::Test {
 protected:
  Outcome run(int frames, const std::string& more = "", const std::string& folder = "a") const {
    return runSpume("run " + scene_ + " --frames " + std::to_string(frames) + " -o " + (scratch_ / folder) +
                    " " + more);
  }
  std::string file(const std::string& name) const { return contentsOf((scratch_ / "a") + name); }
  void removeCheckpoints() const {
    fs::remove_all(scratch_ / "a/checkpoint");
    fs::create_directory(scratch_ / "a/checkpoint");
  }
  /// What a run leaves that was killed before its first checkpoint: run.json says that it goes on.
  void pretendItWasKilled() const {
    removeCheckpoints();
    std::string json = file("/run.json");
    const std::size_t status = json.find("\"done\"");
    ASSERT_NE(status, std::string::npos);
    scratch_.write("a/run.json", json.replace(status, 6, "\"running\""));
  }
  void expectSameFrames(const std::string& folder) const {
    for (int frame = 1; frame <= 3; ++frame)
      for (const std::string stem : {"/liquid/liquid.000", "/bubbles/bubbles.000"}) {
        const std::string name = stem + std::to_string(frame) + ".vdb";
        EXPECT_FALSE(file(name).empty()) << name;
        EXPECT_EQ(file(name), contentsOf((scratch_ / folder) + name)) << name;
      }
  }
  std::size_t rows(const std::string& name) const {
    const std::string text = file(name);
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
  }

  const Scratch scratch_;
  const std::string scene_ = scratch_.write("pour.toml", pour(10));
};

TEST_F(RunFolder, FramesWithoutACheckpointAreNotGivenUpUnasked) {
  ASSERT_EQ(run(3).code, 0);
  removeCheckpoints();
  const std::string before = file("/liquid/liquid.0003.vdb");
  expectRefused(run(3), 4, "--restart starts anew");
  expectRefused(run(3, "--set foam.wetness=0.9"), 2, "foam.wetness = ");
  fs::remove(scratch_ / "a/scene.toml");
  expectRefused(run(3), 4, "no scene.toml");
  EXPECT_EQ(file("/liquid/liquid.0003.vdb"), before);
  EXPECT_EQ(run(3, "--set foam.wetness=0.9 --restart").code, 0);
}

TEST_F(RunFolder, ARunKilledBeforeItsFirstCheckpointIsMadeAgain) {
  ASSERT_EQ(run(3, "", "b").code, 0);
  ASSERT_EQ(run(3).code, 0);
  pretendItWasKilled();
  expectRefused(run(3, "--set foam.wetness=0.9"), 2, "foam.wetness = ");
  ASSERT_EQ(run(3, "--max-wall 0.001s").code, 75);
  expectSameFrames("b");  // those of the killed run are there until their like replaces them
  ASSERT_EQ(run(3).code, 0);
  expectSameFrames("b");
  EXPECT_EQ(file("/events.csv"), contentsOf(scratch_ / "b/events.csv"));
  EXPECT_EQ(rows("/frames.csv"), 4u);
}

/// Its checkpoints were due every second frame: that there is none is not its own doing.
TEST_F(RunFolder, ARunThatHadACheckpointIsNotMadeAgain) {
  scratch_.write("pour.toml", pour(2));
  ASSERT_EQ(run(3).code, 0);
  pretendItWasKilled();
  expectRefused(run(3), 4, "--restart starts anew");
}

/// Its foam costs nothing more by `run`.
TEST_F(RunFolder, AStillPoolHasNoLiquidForTheFoamAlone) {
  fs::create_directory(scratch_ / "still");
  scratch_.write("still/scene.toml",
                 "[domain]\nsize = [1, 1, 1]\n[still_pool]\nenabled = true\nlevel = 0.5\n");
  const Outcome refused = runSpume("foam " + (scratch_ / "still") + " -o " + (scratch_ / "b"));
  expectRefused(refused, 2, "has no solved liquid, but a pool at rest; run its scene with --set instead");
  EXPECT_EQ(refused.errors.find("liquid_cache"), std::string::npos) << refused.errors;
}

TEST_F(RunFolder, AFrameThatCouldNotBeWrittenIsWrittenAfterResuming) {
  ASSERT_EQ(run(3, "", "b").code, 0);
  ASSERT_EQ(run(1).code, 0);
  const std::string obstacle = scratch_ / "a/bubbles/bubbles.0002.vdb";
  fs::create_directories(obstacle + "/in_the_way");
  expectRefused(run(3), 4, "bubbles.0002.vdb");
  EXPECT_NE(file("/run.json").find("\"failed\""), std::string::npos);
  const std::size_t steps = rows("/steps.csv");
  fs::remove_all(obstacle);
  ASSERT_EQ(run(2).code, 0);
  EXPECT_EQ(rows("/steps.csv"), steps) << "the frame's steps were taken again";
  ASSERT_EQ(run(3).code, 0);
  expectSameFrames("b");
  EXPECT_EQ(file("/events.csv"), contentsOf(scratch_ / "b/events.csv"));
  EXPECT_EQ(rows("/frames.csv"), 4u);
}

}  // namespace
}  // namespace spume::apps::test
