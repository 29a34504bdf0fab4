#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

namespace {

namespace fs = std::filesystem;

struct Outcome {
  int code = -1;
  std::string errors;  ///< what was printed to standard error
};

/// A folder that vanishes with the test.
class Scratch {
 public:
  Scratch() : path_(fs::path(::testing::TempDir()) / ("spume_" + std::to_string(getpid()))) {
    fs::create_directories(path_);
  }
  ~Scratch() { fs::remove_all(path_); }
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name) << text;
    return (path_ / name).string();
  }

 private:
  fs::path path_;
};

Outcome spume(const std::string& arguments) {
  Outcome outcome;
  FILE* pipe = popen((std::string(SPUME_PROGRAM) + " " + arguments + " 2>&1 >/dev/null").c_str(), "r");
  std::array<char, 512> buffer;
  while (fgets(buffer.data(), buffer.size(), pipe)) outcome.errors += buffer.data();
  outcome.code = WEXITSTATUS(pclose(pipe));
  return outcome;
}

/// The program refused with `code` and one line that holds `part`.
void expectRefused(const Outcome& outcome, int code, const std::string& part) {
  EXPECT_EQ(outcome.code, code) << outcome.errors;
  EXPECT_NE(outcome.errors.find(part), std::string::npos) << outcome.errors;
  EXPECT_EQ(std::count(outcome.errors.begin(), outcome.errors.end(), '\n'), 1) << outcome.errors;
}

const std::string kSound = "[domain]\nsize = [0.1, 0.1, 0.1]\nresolution = 16\n";

}  // namespace

TEST(CommandLine, HelpIsNoError) {
  EXPECT_EQ(spume("--help").code, 0);
  EXPECT_EQ(spume("run --help").code, 0);
  EXPECT_EQ(spume("--version").code, 0);
  EXPECT_EQ(spume("check --keys").code, 0);
}

TEST(CommandLine, WrongUseIsRefused) {
  EXPECT_EQ(spume("").code, 2);
  expectRefused(spume("fly"), 2, "fly");
  expectRefused(spume("run"), 2, "scene");
  expectRefused(spume("run x.toml --frobnicate"), 2, "frobnicate");
  expectRefused(spume("run x.toml --max-wall soon"), 2, "soon");
  expectRefused(spume("run x.toml --quality best"), 2, "best");
  expectRefused(spume("run x.toml --threads 0"), 2, "threads");
}

TEST(CommandLine, MissingSceneIsAnInputError) {
  expectRefused(spume("check /nonexistent/a.toml"), 4, "/nonexistent/a.toml");
  expectRefused(spume("run /nonexistent/a.toml"), 4, "/nonexistent/a.toml");
  expectRefused(spume("info /nonexistent"), 4, "/nonexistent");
}

TEST(CommandLine, SoundSceneIsAccepted) {
  const Scratch scratch;
  EXPECT_EQ(spume("check " + scratch.write("sound.toml", kSound)).code, 0);
}

TEST(CommandLine, SyntaxErrorNamesThePlace) {
  const Scratch scratch;
  expectRefused(spume("check " + scratch.write("broken.toml", "[domain]\nsize = [0.1, 0.1\n")), 2,
                "broken.toml:");
}

TEST(CommandLine, UnknownKeyNamesTheNearest) {
  const Scratch scratch;
  const std::string path = scratch.write("typo.toml", kSound + "resolutoin = 32\n");
  const Outcome outcome = spume("check " + path);
  expectRefused(outcome, 2, "typo.toml:4:");
  EXPECT_NE(outcome.errors.find("resolution"), std::string::npos) << outcome.errors;
}

TEST(CommandLine, ValueOutOfRangeNamesTheRange) {
  const Scratch scratch;
  const std::string path =
      scratch.write("range.toml", "[domain]\nsize = [0.1, 0.1, 0.1]\nresolution = 4000\n");
  const Outcome outcome = spume("check " + path);
  expectRefused(outcome, 2, "range.toml:3:");
  EXPECT_NE(outcome.errors.find("1024"), std::string::npos) << outcome.errors;
}

TEST(CommandLine, WrongTypeIsRefused) {
  const Scratch scratch;
  const std::string path =
      scratch.write("type.toml", "[domain]\nsize = [0.1, 0.1, 0.1]\nresolution = \"many\"\n");
  expectRefused(spume("check " + path), 2, "type.toml:3:");
}

TEST(CommandLine, OverridesAreCheckedLikeTheFile) {
  const Scratch scratch;
  const std::string path = scratch.write("sound.toml", kSound);
  expectRefused(spume("check " + path + " --resolution 4000"), 2, "resolution");
  expectRefused(spume("check " + path + " --set domain.resolutoin=20"), 2, "resolution");
  expectRefused(spume("check " + path + " --set domain.resolution"), 2, "domain.resolution");
}

TEST(CommandLine, UnwritableOutputLeavesNothing) {
  const Scratch scratch;
  const std::string scene = scratch.write("sound.toml", kSound);
  const std::string file = scratch.write("a_file", "kept\n");
  expectRefused(spume("run " + scene + " -o " + file + "/out"), 4, "a_file");
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  EXPECT_EQ(line, "kept");
}

TEST(CommandLine, RunOfABadSceneCreatesNoFolder) {
  const Scratch scratch;
  const std::string scene = scratch.write("typo.toml", kSound + "resolutoin = 32\n");
  EXPECT_EQ(spume("run " + scene + " -o " + (scratch / "out")).code, 2);
  EXPECT_FALSE(fs::exists(scratch / "out"));
}

TEST(CommandLine, InfoOfSomethingElseIsRefused) {
  const Scratch scratch;
  expectRefused(spume("info " + scratch.write("notes.txt", "hello\n")), 2, "notes.txt");
  expectRefused(spume("info " + scratch.write("bubbles.0001.vdb", "no vdb\n")), 4, "bubbles.0001.vdb");
}
