#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/apps_program.h"

namespace spume::apps::test {
namespace {

/// Water in free fall past a ball: at rest at first, then a pressure solve that one iteration cannot do.
const std::string kUnsolvable =
    "[domain]\nsize = [0.06, 0.06, 0.06]\nresolution = 16\n"
    "[liquid]\npressure_iterations = 1\npressure_tolerance = 1e-12\n"
    "[output]\npreview = false\n"
    "[[liquid_body]]\nname = \"column\"\nshape = \"box\"\nlower = [-0.01, -0.01, -0.01]\nupper = [0.02, "
    "0.04, "
    "0.03]\n";

/// A failed run says what failed, leaves the state before it as a checkpoint, and the same command without
/// the fault goes on from there.
TEST(Divergence, EndsWithCodeThreeAndACheckpoint) {
  const Scratch scratch;
  const std::string scene = scratch.write("dam.toml", kUnsolvable), out = scratch / "out";
  const Outcome failed = runSpume("run " + scene + " --frames 2 -o " + out);
  EXPECT_EQ(failed.code, 3);
  EXPECT_NE(failed.errors.find("pressure: "), std::string::npos) << failed.errors;
  EXPECT_NE(contentsOf(out + "/run.json").find("\"failed\""), std::string::npos);
  ASSERT_TRUE(std::filesystem::exists(out + "/checkpoint"));
  EXPECT_FALSE(std::filesystem::is_empty(out + "/checkpoint"));
}

}  // namespace
}  // namespace spume::apps::test
