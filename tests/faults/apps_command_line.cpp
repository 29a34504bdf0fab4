#include <gtest/gtest.h>

#include <filesystem>
#include <utility>

#include "coupling/folder_lock.h"
#include "tests/support/apps_program.h"

namespace spume::apps::test {
namespace {

const std::string kSound = "[domain]\nsize = [0.1, 0.1, 0.1]\nresolution = 16\n";

TEST(CommandLine, HelpIsNoError) {
  EXPECT_EQ(runSpume("--help").code, 0);
  EXPECT_EQ(runSpume("run --help").code, 0);
  EXPECT_EQ(runSpume("--version").code, 0);
  EXPECT_EQ(runSpume("check --keys").code, 0);
}

TEST(CommandLine, WrongUseIsRefused) {
  expectRefused(runSpume(""), 2, "no verb");
  expectRefused(runSpume("fly"), 2, "fly");
  expectRefused(runSpume("run"), 2, "scene");
  expectRefused(runSpume("run x.toml --frobnicate"), 2, "frobnicate");
  expectRefused(runSpume("run x.toml --max-wall soon"), 2, "soon");
  expectRefused(runSpume("run x.toml --quality best"), 2, "best");
  expectRefused(runSpume("run x.toml --threads 0"), 2, "threads");
}

TEST(CommandLine, MissingSceneIsAnInputError) {
  expectRefused(runSpume("check /nonexistent/a.toml"), 4, "/nonexistent/a.toml");
  expectRefused(runSpume("run /nonexistent/a.toml"), 4, "/nonexistent/a.toml");
  expectRefused(runSpume("info /nonexistent"), 4, "/nonexistent");
}

TEST(CommandLine, SoundSceneIsAccepted) {
  const Scratch scratch;
  EXPECT_EQ(runSpume("check " + scratch.write("sound.toml", kSound)).code, 0);
}

TEST(CommandLine, SyntaxErrorNamesThePlace) {
  const Scratch scratch;
  expectRefused(runSpume("check " + scratch.write("broken.toml", "[domain]\nsize = [0.1, 0.1\n")), 2,
                "broken.toml:");
}

TEST(CommandLine, UnknownKeyNamesTheNearest) {
  const Scratch scratch;
  const std::string path = scratch.write("typo.toml", kSound + "resolutoin = 32\n");
  const Outcome outcome = runSpume("check " + path);
  expectRefused(outcome, 2, "typo.toml:4:");
  EXPECT_NE(outcome.errors.find("resolution"), std::string::npos) << outcome.errors;
}

TEST(CommandLine, ValueOutOfRangeNamesTheRange) {
  const Scratch scratch;
  const std::string path =
      scratch.write("range.toml", "[domain]\nsize = [0.1, 0.1, 0.1]\nresolution = 4000\n");
  const Outcome outcome = runSpume("check " + path);
  expectRefused(outcome, 2, "range.toml:3:");
  EXPECT_NE(outcome.errors.find("1024"), std::string::npos) << outcome.errors;
}

TEST(CommandLine, WrongTypeIsRefused) {
  const Scratch scratch;
  const std::string path =
      scratch.write("type.toml", "[domain]\nsize = [0.1, 0.1, 0.1]\nresolution = \"many\"\n");
  expectRefused(runSpume("check " + path), 2, "type.toml:3:");
}

TEST(CommandLine, OverridesAreCheckedLikeTheFile) {
  const Scratch scratch;
  const std::string path = scratch.write("sound.toml", kSound);
  expectRefused(runSpume("check " + path + " --resolution 4000"), 2, "resolution");
  expectRefused(runSpume("check " + path + " --set domain.resolutoin=20"), 2, "resolution");
  expectRefused(runSpume("check " + path + " --set domain.resolution"), 2, "domain.resolution");
}

TEST(CommandLine, UnwritableOutputLeavesNothing) {
  const Scratch scratch;
  const std::string scene = scratch.write("sound.toml", kSound);
  const std::string file = scratch.write("a_file", "kept\n");
  expectRefused(runSpume("run " + scene + " -o " + file + "/out"), 4, "a_file");
  EXPECT_EQ(contentsOf(file), "kept\n");
}

TEST(CommandLine, PrintingOnAFullDiskIsAnOutputError) {
  const Scratch scratch;
  const std::string check = "check " + scratch.write("sound.toml", kSound);
  EXPECT_EQ(runSpume(check + " >/dev/full 2>/dev/null || exit $?").code, 4);
}

TEST(CommandLine, AFolderAnotherRunWritesToIsRefused) {
  const Scratch scratch;
  const std::string scene = scratch.write("sound.toml", kSound);
  std::filesystem::create_directories(scratch / "out");
  {
    const coupling::FolderLock other(scratch / "out");
    expectRefused(runSpume("run " + scene + " --frames 1 --no-preview -o " + (scratch / "out")), 4,
                  "another run");
  }
  EXPECT_EQ(runSpume("run " + scene + " --frames 1 --no-preview -o " + (scratch / "out")).code, 0);
}

TEST(CommandLine, ARunDoesNotReplaceFilesOfOthers) {
  const Scratch scratch;
  const std::string scene = scratch.write("scene.toml", "# mine\n" + kSound), folder = scratch / "";
  const std::string run = "run " + scene + " --frames 1 --no-preview -o " + folder;
  expectRefused(runSpume(run), 4, "scene.toml: no run wrote");
  expectRefused(runSpume(run + " --restart"), 4, "scene.toml: no run wrote");
  EXPECT_EQ(contentsOf(scene), "# mine\n" + kSound);
  EXPECT_EQ(scratch.count(), 1u) << "folders were made";
  std::filesystem::create_directories(scratch / "other");
  const std::string log = scratch.write("other/log.txt", "kept\n");
  const std::string next = "run " + scene + " --frames 1 --no-preview -o " + (scratch / "other");
  expectRefused(runSpume(next), 4, "log.txt: no run wrote");
  EXPECT_EQ(contentsOf(log), "kept\n");
  EXPECT_EQ(runSpume(next + " --restart").code, 0);
  EXPECT_EQ(runSpume("run " + (scratch / "other/scene.toml") + " --frames 2 -o " + (scratch / "other")).code,
            0)
      << "a run goes on from the scene it left";
}

TEST(CommandLine, PicturesOfAnIncompleteCacheSayWhatIsMissing) {
  const Scratch scratch;
  const std::string scene = scratch.write("sound.toml", kSound), out = scratch / "out";
  ASSERT_EQ(runSpume("run " + scene + " --frames 4 --no-preview -o " + out).code, 0);
  std::filesystem::remove(out + "/liquid/liquid.0002.vdb");
  std::filesystem::remove(out + "/bubbles/bubbles.0003.vdb");
  std::filesystem::remove(out + "/bubbles/bubbles.0003.ply");
  const std::string render = "render " + out + " --size 16x16 --samples 1";
  for (const auto& [frames, missing] :
       {std::pair{"", "liquid for 2:"}, {" --frames 2-7", "liquid for 2, 5-7:"}}) {
    const Outcome outcome = runSpume(render + frames);
    EXPECT_EQ(outcome.code, 0) << outcome.errors;
    EXPECT_NE(outcome.output.find(missing), std::string::npos) << outcome.output;
    EXPECT_NE(outcome.output.find("bubbles for 3: drawn without"), std::string::npos) << outcome.output;
  }
}

TEST(CommandLine, RunOfABadSceneCreatesNoFolder) {
  const Scratch scratch;
  const std::string scene = scratch.write("typo.toml", kSound + "resolutoin = 32\n");
  EXPECT_EQ(runSpume("run " + scene + " -o " + (scratch / "out")).code, 2);
  EXPECT_FALSE(std::filesystem::exists(scratch / "out"));
}

TEST(CommandLine, InfoOfSomethingElseIsRefused) {
  const Scratch scratch;
  expectRefused(runSpume("info " + scratch.write("notes.txt", "hello\n")), 2, "notes.txt");
  expectRefused(runSpume("info " + scratch.write("bubbles.0001.vdb", "no vdb\n")), 4, "bubbles.0001.vdb");
}

}  // namespace
}  // namespace spume::apps::test
