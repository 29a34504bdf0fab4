#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "apps/reproduce/reproduction.h"
#include "coupling/errors.h"

namespace spume::apps {
namespace {

ResultRow someRow(const std::string& study, double figure) {
  ResultRow row{study, "a \"case\", with comma", "64^3", "volume change", 0, "", "2 %, or less", "someone"};
  row.seconds = 1.5;
  row.note = "slow";
  return aimAtMost(row, figure, 0.5, "%");
}

TEST(ResultTable, ReadsBackWhatItWrote) {
  ResultTable table("title");
  table.set("A", {someRow("A", 0.1), someRow("A", -0.7)});
  table.set("B", {someRow("B", 1.0 / 3)});
  ResultTable read("title");
  read.readCsv(table.csv(), "x.csv");
  EXPECT_EQ(read.rows(), table.rows());
  EXPECT_EQ(read.count(Verdict::met), 2);
  EXPECT_EQ(read.count(Verdict::missed), 1);
}

TEST(ResultTable, ReplacesTheRowsOfACaseAndKeepsTheOrderAskedFor) {
  ResultTable table("title");
  table.set("B", {someRow("B", 0)});
  table.set("A", {someRow("A", 0), someRow("A", 1)});
  table.set("B", {someRow("B", 2)});
  table.order({"A", "B"});
  ASSERT_EQ(table.rows().size(), 3u);
  EXPECT_EQ(table.rows()[0].study, "A");
  EXPECT_EQ(table.rows()[2].figure, 2);
}

TEST(ResultTable, AFigureThatIsNoNumberMissesItsAim) {
  EXPECT_EQ(someRow("A", std::nan("")).verdict, Verdict::missed);
}

TEST(ResultTable, ABandIsMetInsideAndMissedOutside) {
  ResultRow row;
  EXPECT_EQ(aimWithin(row, 13.7, 13.4, 14.1, "-").verdict, Verdict::met);
  EXPECT_EQ(row.aim, "13.4 to 14.1 -");
  EXPECT_EQ(aimWithin(row, 13.3, 13.4, 14.1, "-").verdict, Verdict::missed);
  EXPECT_EQ(aimWithin(row, 14.2, 13.4, 14.1, "-").verdict, Verdict::missed);
  EXPECT_EQ(aimWithin(row, std::nan(""), 13.4, 14.1, "-").verdict, Verdict::missed);
}

TEST(ResultTable, RefusesAnotherFileWithItsPlace) {
  ResultTable table("title");
  EXPECT_THROW(table.readCsv("a,b\n1,2\n", "x.csv"), coupling::SceneError);
  try {
    table.readCsv(ResultTable("").csv() + "1,2\n", "x.csv");
    FAIL();
  } catch (const coupling::SceneError& error) {
    EXPECT_NE(std::string(error.what()).find("x.csv:2"), std::string::npos) << error.what();
  }
}

TEST(Reproductions, HaveUniqueNamesAndCases) {
  std::vector<std::string> seen;
  for (const Reproduction& table : reproductions()) {
    EXPECT_EQ(std::count(seen.begin(), seen.end(), table.name), 0) << table.name;
    seen.push_back(table.name);
    std::vector<std::string> keys;
    for (const Study& study : table.studies) {
      EXPECT_EQ(std::count(keys.begin(), keys.end(), study.key), 0) << study.key;
      keys.push_back(study.key);
      EXPECT_TRUE(study.run && study.cost > 0 && !study.title.empty()) << study.key;
    }
  }
}

}  // namespace
}  // namespace spume::apps
