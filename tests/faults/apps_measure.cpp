#include <gtest/gtest.h>

#include "tests/support/apps_program.h"

namespace spume::apps::test {
namespace {

const std::string kSound = "id,x,y,z,r\n0,0,0,0,1\n1,1,0,0,1\n";

TEST(MeasureFaults, BadRowNamesItsPlaceAndWritesNothing) {
  const Scratch scratch;
  const std::string input = scratch.write("bad.csv", "id,x,y,z,r\n0,0,0,0,1\n1,0,0,3,-2\n");
  expectRefused(runSpume("measure " + input + " -o " + (scratch / "cells.csv")), 2, "bad.csv:3:9: ");
  EXPECT_EQ(scratch.count(), 1u);
}

TEST(MeasureFaults, MissingFileIsAnInputError) {
  expectRefused(runSpume("measure /nonexistent/a.csv"), 4, "/nonexistent/a.csv");
  expectRefused(runSpume("measure /nonexistent/a.ply"), 4, "/nonexistent/a.ply");
  expectRefused(runSpume("measure ."), 2, "expected a .csv, .ply or .vdb");
}

TEST(MeasureFaults, UnwritableOutputIsAnOutputError) {
  const Scratch scratch;
  const std::string input = scratch.write("a.csv", kSound);
  expectRefused(runSpume("measure " + input + " -o /nonexistent/cells.csv"), 4, "/nonexistent/cells.csv");
  expectRefused(runSpume("measure " + input + " --contacts /nonexistent/c.csv"), 4, "/nonexistent/c.csv");
}

TEST(MeasureFaults, NoFileReplacesAnother) {
  const Scratch scratch;
  const std::string input = scratch.write("a.csv", kSound);
  expectRefused(runSpume("measure " + input + " -o " + input), 2, "would replace");
  const std::string both = scratch / "b.csv";
  expectRefused(runSpume("measure " + input + " -o " + both + " --contacts " + both), 2, "the same file");
  expectRefused(runSpume("measure " + input + " -o " + both + " --films " + both), 2, "the same file");
  expectRefused(runSpume("measure " + input + " --films " + input), 2, "would replace");
  EXPECT_EQ(contentsOf(input), kSound);
}

TEST(MeasureFaults, FilmsOfTheGlobalEngineAreRefusedWithARemedy) {
  const Scratch scratch;
  const std::string input = scratch.write("a.csv", kSound);
  expectRefused(runSpume("measure " + input + " --engine global --films " + (scratch / "f.ply")), 2,
                "--films needs --engine local: leave --engine global out");
  EXPECT_EQ(scratch.count(), 1u);
}

TEST(MeasureFaults, WrongUseIsRefused) {
  expectRefused(runSpume("measure"), 2, "bubbles");
  expectRefused(runSpume("measure a.csv --engine fast"), 2, "local");
}

}  // namespace
}  // namespace spume::apps::test
