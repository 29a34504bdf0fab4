#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "coupling/atomic_file.h"
#include "coupling/checkpoint.h"
#include "coupling/scene_toml.h"
#include "coupling/state_archive.h"
#include "tests/support/temporary_path.h"

namespace spume::coupling {
namespace {

namespace fs = std::filesystem;

std::string bytesOf(SimulationState state) {
  ArchiveWriter writer;
  archive(writer, state);
  return writer.bytes;
}

/// A state with something in every column.
SimulationState someState(int frame) {
  SimulationState state;
  state.frame = frame;
  state.step = 5 * frame;
  state.time = frame / 30.0;
  state.liquid.grid = {{5, 6, 7}, 0.01, {1, 2, 3}};
  state.liquid.phi = fluid::DenseField<float>(state.liquid.grid.cells, -0.1f);
  state.liquid.phi(1, 2, 3) = 1.0f / 3;
  state.liquid.velocity = fluid::MacVelocity(state.liquid.grid.cells, 0.7f);
  state.liquid.pressureGradient = fluid::MacField<float>(state.liquid.grid.cells, 9.8f);
  state.liquid.positive.append(1.5f, 2.5f, 3.5f, 0.25f);
  state.liquid.negative.append(0.5f, 0.25f, 0.125f, 0.5f);
  state.liquid.volume.target = {0.5, 0.25};
  for (int n = 0; n < 10; ++n) state.bubbles.add({{0.1 * n, 1.0 / 3, 0}, {0, 0.3, 0}, 1e-3});
  state.reservoirs[{1, -2, 3}] = {1e-9 / 3, 7};
  state.gas.bornMarkers = 1e-6 / 7;
  state.foamDt = 0.0123;
  return state;
}

class Checkpoint : public testing::Test {
 protected:
  void SetUp() override {
    scene_.domain.size = {1, 1, 1};
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  void write(int first, int last) {
    for (int frame = first; frame <= last; ++frame) writeCheckpoint(folder_, scene_, someState(frame));
  }
  std::string path(int frame) const { return folder_ + "/checkpoint.00000" + std::to_string(frame) + ".bin"; }

  Scene scene_;
  std::string folder_ = temporaryPath("spume_checkpoint");
};

TEST_F(Checkpoint, StateReadsBackBitForBit) {
  write(3, 3);
  const auto loaded = readNewestCheckpoint(folder_, scene_);
  ASSERT_TRUE(loaded);
  EXPECT_EQ(bytesOf(loaded->state), bytesOf(someState(3)));
  EXPECT_TRUE(loaded->warnings.empty());
  EXPECT_EQ(loaded->state.liquid.phi(1, 2, 3), 1.0f / 3);
  EXPECT_EQ(loaded->state.reservoirs.at({1, -2, 3}).draws, 7u);
}

TEST_F(Checkpoint, EmptyOrMissingFolderHoldsNone) {
  EXPECT_FALSE(readNewestCheckpoint(folder_, scene_));
  EXPECT_FALSE(readNewestCheckpoint("/no/such/folder", scene_));
}

TEST_F(Checkpoint, TheTwoNewestAreKept) {
  write(1, 5);
  EXPECT_FALSE(fs::exists(path(3)));
  EXPECT_TRUE(fs::exists(path(4)));
  EXPECT_EQ(readNewestCheckpoint(folder_, scene_)->state.frame, 5);
}

TEST_F(Checkpoint, DamagedNewestFallsBackWithAWarning) {
  write(4, 5);
  fs::resize_file(path(5), fs::file_size(path(5)) - 100);
  const auto cut = readNewestCheckpoint(folder_, scene_);
  EXPECT_EQ(cut->state.frame, 4);
  ASSERT_EQ(cut->warnings.size(), 1u);
  EXPECT_NE(cut->warnings[0].find(path(5) + ": damaged"), std::string::npos) << cut->warnings[0];
}

TEST_F(Checkpoint, EveryFlippedByteIsNoticed) {
  write(4, 5);
  const std::string whole = readFile(path(5));
  for (std::size_t at = 0; at < whole.size(); at += 1 + whole.size() / 97) {
    if (at >= 12 && at < 16) continue;  // the reserved word of the header means nothing
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x10);
    replaceFile(path(5), damaged);
    EXPECT_EQ(readNewestCheckpoint(folder_, scene_)->state.frame, 4) << "byte " << at;
  }
}

TEST_F(Checkpoint, OnlyDamagedOnesAreAFileError) {
  write(5, 5);
  replaceFile(path(5), "");
  EXPECT_THROW(readNewestCheckpoint(folder_, scene_), FileError);
}

TEST_F(Checkpoint, OtherSceneIsRefusedWithTheDifference) {
  write(5, 5);
  Scene other = scene_;
  other.foam.wetness = 0.5;
  other.seed = 9;
  try {
    readNewestCheckpoint(folder_, other);
    FAIL() << "a checkpoint of another scene was taken";
  } catch (const SceneError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("foam.wetness = 0.4 there, 0.5 here"), std::string::npos) << message;
    EXPECT_NE(message.find("scene.seed = 1 there, 9 here"), std::string::npos) << message;
  }
}

TEST_F(Checkpoint, KeysThatDoNotChangeTheMotionMayDiffer) {
  write(5, 5);
  Scene longer = scene_;
  longer.time.frames = 900;
  longer.title = "the long version";
  longer.output.preview = false;
  EXPECT_TRUE(readNewestCheckpoint(folder_, longer));
}

TEST(SceneDifferences, NamesAddedAndRemovedObjects) {
  Scene a, b;
  b.inflows.emplace_back();
  const auto differences = sceneDifferences(writeScene(a), writeScene(b));
  EXPECT_NE(std::find(differences.begin(), differences.end(), "inflow.0.radius = absent there, 0.01 here"),
            differences.end());
}

}  // namespace
}  // namespace spume::coupling
