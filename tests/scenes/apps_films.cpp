// Films as users get them: from a run, from a table of balls, in a picture.
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/apps_program.h"

namespace spume::apps::test {
namespace {

/// A dozen bubbles that touch, in a glass with some water.
const std::string kScene = R"([domain]
size = [0.08, 0.08, 0.08]
resolution = 16
[time]
frames = 2
[still_pool]
enabled = true
level = 0.02
[coupling.entrainment]
enabled = false
[foam]
wetness = 0.2
[[bubbles]]
file = "balls.csv"
[output]
films = true
preview = false
)";
const std::string kBalls =
    "id,x,y,z,r\n0,0.034,0.04,0.04,0.007\n1,0.044,0.04,0.04,0.006\n2,0.039,0.049,0.04,0.007\n"
    "3,0.039,0.043,0.049,0.006\n4,0.006,0.04,0.04,0.007\n5,0.014,0.04,0.04,0.006\n";

std::string headerOf(const std::string& ply) { return ply.substr(0, ply.find("end_header")); }

TEST(Films, ComeFromARunAndFromATableAndArePutIntoAPicture) {
  const Scratch scratch;
  const std::string scene = scratch.write("films.toml", kScene), balls = scratch.write("balls.csv", kBalls);
  const std::string out = scratch / "out";
  const Outcome run = runSpume("run " + scene + " -o " + out);
  ASSERT_EQ(run.code, 0) << run.errors;
  for (const char* frame : {"0001", "0002"}) {
    const std::string ply = contentsOf(out + "/films/films." + frame + ".ply");
    EXPECT_NE(headerOf(ply).find("property float curvature"), std::string::npos) << frame;
  }
  const Outcome info = runSpume("info " + out);
  EXPECT_NE(info.output.find("film_frames      1-2"), std::string::npos) << info.output;

  const std::string table = scratch / "films.ply";
  ASSERT_EQ(runSpume("measure " + balls + " --films " + table).code, 0);
  EXPECT_EQ(headerOf(contentsOf(table)).rfind("ply\nformat binary_little_endian 1.0\n", 0), 0u);

  const std::string render = "render " + out + " --frames 2 --size 96x72 --samples 1 --films ";
  const std::string picture = out + "/render/beauty.0002.png";
  ASSERT_EQ(runSpume(render + "plane").code, 0);
  const std::string plane = contentsOf(picture);
  ASSERT_EQ(runSpume(render + "curved").code, 0);
  EXPECT_NE(contentsOf(picture), plane);
  expectRefused(runSpume(render + "round"), 2, "curved");
}

}  // namespace
}  // namespace spume::apps::test
