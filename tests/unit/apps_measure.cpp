#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <ostream>
#include <sstream>

#include "tests/support/measured_foam.h"

namespace spume::apps::test {
namespace {

using Eigen::Vector3d;
using foam::test::capVolume;
using foam::test::latticeBlock;

constexpr double kPi = std::numbers::pi;
/// Round-off: sums of about 50 terms of size r^3, and the square of the tie-breaking jitter; the tabled
/// values carry 12 decimals.
constexpr double kRelative = 1e-10;
constexpr double kTableDigits = 6e-13;

Balls ballsAt(const std::vector<std::pair<Vector3d, double>>& list) {
  Balls balls;
  for (const auto& [x, r] : list) balls.add(x, r);
  return balls;
}

/// Balls with the volumes of their first cells (accuracy, Section 5).
struct Case {
  std::string name;
  Balls balls;
  std::vector<double> volumes;

  friend void PrintTo(const Case& given, std::ostream* out) { *out << given.name; }
};

const std::vector<Vector3d> kSimple = {Vector3d::Zero()};
const std::vector<Vector3d> kBodyCentred = {Vector3d::Zero(), Vector3d::Constant(.5)};
const Vector3d kThird{.5, std::sqrt(.75), 0}, kFourth{.5, std::sqrt(1. / 12), std::sqrt(2. / 3)};

std::vector<Case> cases() {
  const double v5 = 3.103736710859, v6 = 2.791585698220;
  return {
      {"V1", ballsAt({{{0, 0, 0}, 1}, {{1, 0, 0}, 1}}), {9 * kPi / 8, 9 * kPi / 8}},
      {"V2", ballsAt({{{0, 0, 0}, 1}, {{1.2, 0, 0}, .6}}), {4.135421914770, .790595366059}},
      {"V3", ballsAt({{{0, 0, 0}, 1}, {{std::sqrt(.75), 0, 0}, .5}}), {4.134919387157, kPi / 12}},
      {"V4", ballsAt({{{0, 0, 0}, 1}, {{.85, 0, 0}, .3}}), {4.183902857694, .026768770924}},
      {"V5", ballsAt({{{0, 0, 0}, 1}, {{1, 0, 0}, 1}, {kThird, 1}}), {v5, v5, v5}},
      {"V6", ballsAt({{{0, 0, 0}, 1}, {{1, 0, 0}, 1}, {kThird, 1}, {kFourth, 1}}), {v6, v6, v6, v6}},
      {"V7",
       ballsAt({{{0, 0, 0}, 1}, {{1.1, .2, .1}, .8}, {{.3, .9, -.2}, .6}}),
       {3.873052378227, 1.797791485346, .603448288996}},
      {"V10", latticeBlock(kSimple, 1, .6), {4 * kPi / 3 * .216 - 6 * capVolume(.6, .1)}},
      {"V10Full", latticeBlock(kSimple, 2, .9), {1}},
      {"V11Wet", latticeBlock(kBodyCentred, 2, .45), {.378480943723}},
      {"V11Touching", latticeBlock(kBodyCentred, 2, .5), {.469727957969}},
      {"V11Dry", latticeBlock(kBodyCentred, 2, .55), {.499930264393}},
  };
}

class MeasuredVolumes : public testing::TestWithParam<Case> {};

TEST_P(MeasuredVolumes, AreTheTabledOnesFromBothEngines) {
  const Case& given = GetParam();
  for (const char* engine : {"--engine local", "--engine global"}) {
    const MeasuredFoam foam = measured(given.balls, engine);
    ASSERT_EQ(foam.cells.size(), given.balls.size());
    for (std::size_t i = 0; i < given.volumes.size(); ++i)
      EXPECT_NEAR(foam.cells[i].volume, given.volumes[i], kRelative * given.volumes[i] + kTableDigits)
          << engine << " ball " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Accuracy, MeasuredVolumes, testing::ValuesIn(cases()),
                         [](const auto& given) { return given.param.name; });

TEST(Measure, PairHasOneDiscAsFilmAndTwoCapsLess) {
  const MeasuredFoam foam = measured(ballsAt({{{0, 0, 0}, 1}, {{1, 0, 0}, 1}}));
  ASSERT_EQ(foam.contacts.size(), 1u);
  EXPECT_EQ(foam.contacts[0].a, 0u);
  EXPECT_EQ(foam.contacts[0].b, 1u);
  EXPECT_EQ(foam.contacts[0].distance, 1);
  EXPECT_NEAR(foam.contacts[0].filmArea, .75 * kPi, kRelative * kPi);
  for (const CellRow& cell : foam.cells) {
    EXPECT_NEAR(cell.filmArea, .75 * kPi, kRelative * kPi);
    EXPECT_NEAR(cell.freeArea, 3 * kPi, kRelative * 3 * kPi);  // 4 pi less a cap of height 1/2
    EXPECT_EQ(cell.films, 1);
    EXPECT_EQ(cell.hidden, 0);
  }
}

TEST(Measure, SwallowedBallIsFlaggedAndListed) {
  const MeasuredFoam foam = measured(ballsAt({{{0, 0, 0}, 1}, {{.2, 0, 0}, .3}}));
  ASSERT_EQ(foam.cells.size(), 2u);
  EXPECT_EQ(foam.cells[0].hidden, 0);
  EXPECT_EQ(foam.cells[1].hidden, 1);
  EXPECT_EQ(foam.cells[1].volume, 0);
  EXPECT_NEAR(foam.cells[0].volume, 4 * kPi / 3, kRelative * 4);
  EXPECT_TRUE(foam.contacts.empty());
}

TEST(Measure, RowsKeepTheOrderOfTheInputAndContactsThatOfTheIds) {
  Balls row;
  for (int i = 0; i < 4; ++i) row.add({1.5 * i, 0, 0}, 1);
  row.id = {30, 10, 40, 20};
  const MeasuredFoam foam = measured(row);
  for (std::size_t i = 0; i < row.size(); ++i) EXPECT_EQ(foam.cells[i].id, row.id[i]);
  ASSERT_EQ(foam.contacts.size(), 3u);
  const std::pair<std::uint64_t, std::uint64_t> expected[] = {{10, 30}, {10, 40}, {20, 40}};
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_EQ(std::make_pair(foam.contacts[k].a, foam.contacts[k].b), expected[k]);
}

TEST(Measure, TotalsAreThoseOfTheUnion) {
  const Scratch scratch;
  const std::string input = scratch.write("pair.csv", "id,x,y,z,r\n0,0,0,0,1\n1,1,0,0,1\n");
  const Outcome outcome = runSpume("measure " + input);
  EXPECT_EQ(outcome.code, 0) << outcome.errors;
  for (const char* part : {"bubbles", "hidden", "contacts", "7.0685834", "18.849555", "2.3561944", "seconds"})
    EXPECT_NE(outcome.output.find(part), std::string::npos) << part << " is not in:\n" << outcome.output;
}

/// The number that a JSON object gives a key.
double valueOf(const std::string& report, const std::string& key) {
  return std::stod(report.substr(report.find(':', report.find('"' + key + '"')) + 1));
}

TEST(Measure, TotalsOfTheReportAreExact) {
  const Scratch scratch;
  const std::string input = scratch.write("ball.csv", "id,x,y,z,r\n0,0,0,0,0.7\n"), cells = scratch / "c.csv";
  const Outcome outcome = runSpume("measure " + input + " --json -o " + cells);
  const std::string row = contentsOf(cells);  // of the one bubble, whose sums are the totals
  std::istringstream fields(row.substr(row.find("\n0,") + 3));
  for (const char* key : {"volume", "free_area"}) {
    std::string field;
    std::getline(fields, field, ',');
    EXPECT_EQ(valueOf(outcome.output, key), std::stod(field)) << outcome.output;
  }
  const std::string shown = runSpume("measure " + input).output;
  EXPECT_NE(shown.find(row.substr(row.find("\n0,") + 3, 8)), std::string::npos) << shown;
}

TEST(Measure, WarnsOfColumnsThatItDoesNotRead) {
  const Scratch scratch;
  const std::string input = scratch.write("one.csv", "id,x,y,z,r,lambda\n0,0,0,0,1,0.5\n");
  const Outcome outcome = runSpume("measure " + input);
  EXPECT_EQ(outcome.code, 0);
  EXPECT_NE(outcome.errors.find("warning: " + input + ": column 'lambda' is not read"), std::string::npos);
}

TEST(Measure, ReadsPlyLikeCsv) {
  const Scratch scratch;
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty double x\nproperty double y\nproperty double z\n"
      "property double radius\nend_header\n";
  const std::string input = scratch.write("pair.ply", header + "0 0 0 1\n1.2 0 0 0.6\n");
  EXPECT_EQ(runSpume("measure " + input + " -o " + (scratch / "cells.csv")).code, 0);
  const MeasuredFoam same = measured(ballsAt({{{0, 0, 0}, 1}, {{1.2, 0, 0}, .6}}));
  EXPECT_EQ(contentsOf(scratch / "cells.csv"), same.cellText);
}

}  // namespace
}  // namespace spume::apps::test
