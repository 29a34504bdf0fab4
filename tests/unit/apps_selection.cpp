#include <gtest/gtest.h>

#include <map>

#include "apps/reproduce/selection.h"
#include "coupling/errors.h"

namespace spume::apps {
namespace {

Study study(const std::string& key, double cost) {
  return {key, key, cost, [](const StudyContext&) { return std::vector<ResultRow>{}; }};
}

const std::vector<Reproduction> kTables{{"liquid", "", {study("L1", 1), study("L2", 100)}},
                                        {"scenes", "", {study("soap", 10), study("coke", 20)}}};

TEST(Selection, TakesTablesWholeAndCasesOneByOne) {
  const auto both = select(kTables, {"all"}, {});
  ASSERT_EQ(both.size(), 2u);
  const auto one = select(kTables, {"coke"}, {});
  ASSERT_EQ(one.size(), 1u);
  EXPECT_EQ(one[0].table->name, "scenes");
  EXPECT_FALSE(one[0].wants(kTables[1].studies[0], 1000));
  EXPECT_TRUE(one[0].wants(kTables[1].studies[1], 0));  // named, so its cost does not count
}

TEST(Selection, LeavesOutWhatIsTooDearUnlessNamed) {
  const auto table = select(kTables, {"liquid"}, {});
  EXPECT_TRUE(table[0].wants(kTables[0].studies[0], 50));
  EXPECT_FALSE(table[0].wants(kTables[0].studies[1], 50));
  EXPECT_TRUE(select(kTables, {"liquid"}, {"L2"})[0].wants(kTables[0].studies[1], 50));
}

TEST(Selection, RefusesUnknownWordsWithTheNearest) {
  const auto complaint = [](const std::vector<std::string>& targets, const std::vector<std::string>& cases) {
    try {
      select(kTables, targets, cases);
    } catch (const coupling::SceneError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(complaint({"sope"}, {}).find("did you mean soap?"), std::string::npos);
  EXPECT_NE(complaint({"liquid"}, {"L3"}).find("unknown case L3"), std::string::npos);
  EXPECT_NE(complaint({"liquid"}, {"soap"}).find("unknown case soap"),
            std::string::npos);  // of another table
}

/// Two files that offer their studies under one name of a function would both link to one of them.
TEST(Reproductions, HaveEveryCaseInOneTableOnly) {
  std::map<std::string, std::string> tableOf;
  for (const Reproduction& table : reproductions())
    for (const Study& study : table.studies) {
      const auto [first, isNew] = tableOf.emplace(study.key, table.name);
      EXPECT_TRUE(isNew) << study.key << " of " << table.name << " is also in " << first->second;
    }
  EXPECT_EQ(tableOf["F1"], "liquid");
  EXPECT_EQ(tableOf["B7"], "foam");
}

}  // namespace
}  // namespace spume::apps
