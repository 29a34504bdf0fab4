#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <vector>

#include "coupling/bubble_cache.h"
#include "coupling/cache_listing.h"
#include "coupling/cached_liquid.h"
#include "coupling/liquid_recording.h"
#include "coupling/scene_toml.h"
#include "tests/support/apps_program.h"

namespace spume::apps::test {
namespace {

/// A jet into a pool, small enough for a test and fast enough to catch air; a source beside it.
const std::string kPour =
    "[domain]\nsize = [0.06, 0.06, 0.06]\nresolution = 16\n"
    "[output]\npreview = false\ncheckpoint_every = 2\n"
    "[coupling.entrainment]\nblock_size = 0.01\nonset = 0.7\n"
    "[[liquid_body]]\nname = \"pool\"\nshape = \"box\"\nlower = [-0.01, -0.01, -0.01]\nupper = [0.07, 0.02, "
    "0.07]\n"
    "[[inflow]]\nname = \"jet\"\ncentre = [0.025, 0.05, 0.03]\ndirection = [0, -1, 0]\nradius = 0.008\nspeed "
    "= 1.2\n"
    "[[bubble_source]]\nname = \"air\"\nshape = \"box\"\nlower = [0.04, 0.004, 0.01]\nupper = [0.055, 0.01, "
    "0.05]\nrate = 400\n"
    "[[probe]]\nname = \"deep\"\nkind = \"pressure\"\nposition = [0.03, 0.01, 0.03]\n";

constexpr int kFrames = 9;
/// Share of the bubbles that may burst earlier or later because they rise another way: births and sources,
/// nine in ten of which live on at the end, are the same.
constexpr double kOtherPaths = 0.1;
constexpr double kClosedTwice =
    0.01;  // of the volume: a surface closed at the walls moves when it is closed again

/// The pour, run once for all tests.
class FoamAgain : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    scratch_ = new Scratch;
    const std::string scene = scratch_->write("pour.toml", kPour);
    const Outcome done = runSpume("run " + scene + " --frames 9 -o " + run());
    ASSERT_EQ(done.code, 0) << done.errors;
  }
  static void TearDownTestSuite() { delete scratch_; }
  static std::string run() { return *scratch_ / "run"; }
  static std::string at(const std::string& name) { return *scratch_ / name; }
  static foam::BubbleStore lastBubbles(const std::string& folder) {
    return coupling::readBubblesVdb(folder + "/bubbles/bubbles.0009.vdb").bubbles;
  }

  static Scratch* scratch_;
};
Scratch* FoamAgain::scratch_ = nullptr;

TEST_F(FoamAgain, BearsTheSameBubblesInTheSameLiquid) {
  const Outcome done = runSpume("foam " + run() + " -o " + at("same"));
  ASSERT_EQ(done.code, 0) << done.errors;
  EXPECT_NE(done.output.find("probes of a pressure are left out"), std::string::npos);
  const coupling::LiquidRecording before(run()), again(at("same"));
  ASSERT_GT(before.births().size(), 5u) << "the jet must catch air";
  ASSERT_EQ(again.births().size(), before.births().size());
  for (std::size_t n = 0; n < before.births().size(); ++n) {
    EXPECT_EQ(again.births()[n].position, before.births()[n].position) << n;
    EXPECT_EQ(again.births()[n].radius, before.births()[n].radius) << n;
  }
  ASSERT_EQ(again.steps().size(), before.steps().size()) << "the recorded steps are taken";
  for (int n = 0; n < kFrames; ++n) {
    const auto there = coupling::readLiquidFrame(before.frames().paths[n]),
               here = coupling::readLiquidFrame(again.frames().paths[n]);
    EXPECT_NEAR(coupling::cachedLiquidVolume(here), coupling::cachedLiquidVolume(there),
                kClosedTwice * coupling::cachedLiquidVolume(there))
        << "frame " << n + 1;
  }
  const foam::BubbleStore there = lastBubbles(run()), here = lastBubbles(at("same"));
  ASSERT_GT(there.size(), 50u);
  EXPECT_NEAR(static_cast<double>(here.size()), static_cast<double>(there.size()),
              kOtherPaths * there.size());
  double heightThere = 0, heightHere = 0;
  for (const auto& x : there.position) heightThere += x.y() / there.size();
  for (const auto& x : here.position) heightHere += x.y() / here.size();
  const double dx = 0.06 / 16;
  EXPECT_NEAR(heightHere, heightThere, dx) << "velocities are means of cell centres, half of them blended";
}

TEST_F(FoamAgain, TakesOtherKeysOfTheFoam) {
  const Outcome done = runSpume("foam " + run() + " -o " + at("none") +
                                " --set coupling.entrainment.enabled=false --set bubble_source.0.rate=0");
  ASSERT_EQ(done.code, 0) << done.errors;
  EXPECT_EQ(lastBubbles(at("none")).size(), 0u);
  const Outcome many = runSpume("foam " + run() + " -o " + at("many") + " --set bubble_source.0.rate=1200");
  ASSERT_EQ(many.code, 0) << many.errors;
  EXPECT_GT(lastBubbles(at("many")).size(), lastBubbles(run()).size() + 100);
}

TEST_F(FoamAgain, GoesOnAsIfItHadNotStopped) {
  ASSERT_EQ(runSpume("foam " + run() + " -o " + at("whole")).code, 0);
  ASSERT_EQ(runSpume("foam " + run() + " -o " + at("halves") + " --frames 5 --threads 1").code, 0);
  ASSERT_EQ(runSpume("foam " + run() + " -o " + at("halves")).code, 0);
  for (const char* file : {"/liquid/liquid.0009.vdb", "/bubbles/bubbles.0009.vdb", "/events.csv"}) {
    ASSERT_FALSE(contentsOf(at("whole") + file).empty()) << file;
    EXPECT_EQ(contentsOf(at("whole") + file), contentsOf(at("halves") + file)) << file;
  }
}

TEST_F(FoamAgain, RefusesAnotherLiquid) {
  const std::string verb = "foam " + run() + " -o " + at("refused");
  expectRefused(runSpume(verb + " --set liquid.cfl=2"), 2, "liquid.cfl = 4 there, 2 here");
  expectRefused(runSpume(verb + " --set domain.resolution=20"), 2, "domain.resolution");
  expectRefused(runSpume(verb + " --set inflow.0.speed=1"), 2, "inflow.0.speed");
  expectRefused(runSpume(verb + " --set coupling.entrainment.sigma=0.1"), 2, "coupling.entrainment.sigma");
  expectRefused(runSpume(verb + " --frames 10"), 2, "up to frame 9");
  expectRefused(runSpume("foam " + run() + " -o " + run() + "/"), 2, "is the folder whose liquid is read");
  expectRefused(runSpume("foam " + at("nothing")), 4, "nothing/scene.toml");
  EXPECT_FALSE(std::filesystem::exists(at("refused") + "/scene.toml"));
}

TEST_F(FoamAgain, IsNamedAfterTheRunHoweverThatIsGiven) {
  std::filesystem::create_directory_symlink(run(), at("a run"));
  ASSERT_EQ(runSpume("foam '" + at("a run") + "/.' --frames 1").code, 0);
  EXPECT_TRUE(std::filesystem::exists(at("a run_foam") + "/run.json"));
  expectRefused(runSpume("foam " + run() + " -o " + at("longer") + " --set time.frames=12"), 2,
                "up to frame 9");
}

TEST_F(FoamAgain, KnowsOfNoBirthsThatWereNotRecorded) {
  const std::string scene = scratch_->write("calm.toml", kPour);
  ASSERT_EQ(
      runSpume("run " + scene + " --frames 1 --set coupling.entrainment.enabled=false -o " + at("calm")).code,
      0);
  expectRefused(runSpume("foam " + at("calm") + " --set coupling.entrainment.enabled=true"), 2,
                "coupling.entrainment.enabled = false there, true here");
}

TEST_F(FoamAgain, GoesOverFramesThatAreNotCached) {
  const std::string scene = scratch_->write("sparse.toml", kPour);
  ASSERT_EQ(runSpume("run " + scene + " --frames 9 --set output.every=3 -o " + at("sparse")).code, 0);
  ASSERT_EQ(runSpume("foam " + at("sparse") + " --set output.every=9").code, 0);
  const auto there = lastBubbles(at("sparse")), here = lastBubbles(at("sparse_foam"));
  EXPECT_NEAR(static_cast<double>(here.size()), static_cast<double>(there.size()),
              kOtherPaths * there.size());
}

/// The recorded liquid itself.
class RecordedLiquid : public FoamAgain {
 protected:
  static coupling::CachedLiquid liquid() {
    coupling::Scene scene =
        coupling::readScene(run() + "/scene.toml", {{"liquid_cache.run", run()}, {"time.frames", "9"}});
    scene.probes.clear();
    return coupling::CachedLiquid(scene);
  }
};

TEST_F(RecordedLiquid, BeginsWithThePoolAlone) {
  const double pool = 0.06 * 0.06 * 0.02, cell = std::pow(0.06 / 16, 3);
  EXPECT_NEAR(liquid().liquidVolume(), pool, 2 * cell) << "not with what the first step poured";
}

TEST_F(RecordedLiquid, TakesAStepBackToTheBit) {
  coupling::CachedLiquid taken = liquid(), straight = liquid();
  const double dt = 1.0 / 30;
  taken.step(5 * dt, {}, {}), straight.step(5 * dt, {}, {});
  const std::size_t before = taken.recordedBirths().size();
  std::size_t born = before;
  taken.step(dt, {}, {});
  const std::size_t whole = taken.recordedBirths().size();
  taken.rollBack();
  for (int half = 0; half < 2; ++half) {
    taken.step(dt / 2, {}, {});
    born += taken.recordedBirths().size();
  }
  straight.step(dt, {}, {});
  EXPECT_EQ(born, before + whole) << "births of a halved step are born once";
  EXPECT_GT(whole, 0u);
  for (int i = 0; i < 16; ++i)
    for (int j = 0; j < 16; ++j) EXPECT_EQ(taken.state().phi(i, j, 8), straight.state().phi(i, j, 8));
}

TEST_F(FoamAgain, NeedsCachedLiquid) {
  const std::string scene = scratch_->write("bare.toml", kPour);
  ASSERT_EQ(runSpume("run " + scene + " --frames 1 --set output.liquid=false -o " + at("bare")).code, 0);
  expectRefused(runSpume("foam " + at("bare")), 2, "holds no cached liquid");
}

}  // namespace
}  // namespace spume::apps::test
