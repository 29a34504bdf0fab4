#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "apps/wedge/shell_word.h"
#include "apps/wedge/variation.h"
#include "apps/wedge/wedge_summary.h"
#include "tests/support/apps_program.h"

namespace spume::apps {
namespace {

using coupling::Overrides;
using Words = std::vector<std::string>;

std::string complaint(const std::function<void()>& act) {
  try {
    act();
  } catch (const coupling::SceneError& error) {
    return error.what();
  }
  return "none";
}

TEST(Variation, SplitsAtCommasBetweenValuesAlone) {
  EXPECT_EQ(parseVariation("liquid.cfl=1,2, 4").values, (Words{"1", "2", "4"}));
  EXPECT_EQ(parseVariation("liquid.cfl=1,2").key, "liquid.cfl");
  EXPECT_EQ(parseVariation("inflow.0.direction=[0,-1,0],[0.2, -1, 0]").values,
            (Words{"[0,-1,0]", "[0.2, -1, 0]"}));
  EXPECT_EQ(parseVariation("a.b={ keys = [[0, 1], [2, 3]] },5").values,
            (Words{"{ keys = [[0, 1], [2, 3]] }", "5"}));
  EXPECT_EQ(parseVariation("a.b=\"x,y\",'u,[v',z").values, (Words{"\"x,y\"", "'u,[v'", "z"}));
  EXPECT_EQ(parseVariation("a.b=\"x\\\",y\",z").values, (Words{"\"x\\\",y\"", "z"}));
}

TEST(Variation, RefusesWhatIsNoListAndNamesIt) {
  for (const char* text : {"liquid.cfl", "=1,2", "a.b=", "a.b=1,,2", "a.b=1,2,", "a.b=[1,2", "a.b=1]",
                           "a.b=\"1", "a.b=[1},2", "a.b=1,1"}) {
    const std::string said = complaint([&] { parseVariation(text); });
    EXPECT_EQ(said.rfind(std::string("--vary ") + text + ": ", 0), 0u) << said;
  }
}

TEST(Combinations, AreTheCrossProductTheLastKeyFastest) {
  const auto all = combinations({parseVariation("a.b=1,2"), parseVariation("c.d=x,y,z")});
  ASSERT_EQ(all.size(), 6u);
  EXPECT_EQ(folderNames(all), (Words{"a.b=1__c.d=x", "a.b=1__c.d=y", "a.b=1__c.d=z", "a.b=2__c.d=x",
                                     "a.b=2__c.d=y", "a.b=2__c.d=z"}));
  for (const Overrides& one : all)
    for (const coupling::Override& given : one) EXPECT_EQ(given.option, "--vary");
  EXPECT_EQ(combinations({}).size(), 1u);
}

TEST(Combinations, RefusesAKeyTwiceAndTooMany) {
  const Variation once = parseVariation("a.b=1,2"), again = parseVariation("a.b=3");
  EXPECT_EQ(complaint([&] { combinations({once, again}); }).rfind("--vary a.b=3: ", 0), 0u);
  Variation many{"c.d=...", "c.d", Words(kMostVariants / 2 + 1, "1")};
  EXPECT_EQ(complaint([&] { combinations({once, many}); }).rfind("--vary c.d=...: ", 0), 0u);
  many.values.resize(kMostVariants / 2);
  EXPECT_EQ(combinations({once, many}).size(), kMostVariants);
}

TEST(FolderNames, AreSafeShortAndUnique) {
  const auto names = folderNames({{{"a.b", "[0, -1, 0]"}},
                                  {{"a.b", "{0, -1; 0}"}},
                                  {{"a.b", "\"ä/ ../x\""}},
                                  {{"a.b", "[]"}},
                                  {{"a.b", std::string(300, 'x')}},
                                  {{"a.b", std::string(301, 'x')}}});
  EXPECT_EQ(names[0], "a.b=0_-1_0");
  EXPECT_EQ(names[1], "a.b=0_-1_0__2");
  EXPECT_EQ(names[3], "a.b=value");
  EXPECT_NE(names[4], names[5]);
  for (const std::string& name : names) {
    EXPECT_LE(name.size(), kLongestName);
    EXPECT_EQ(name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-_.+="), std::string::npos) << name;
  }
}

TEST(ShellWord, ComesThroughAShellUnchanged) {
  const apps::test::Scratch scratch;
  for (const std::string odd :
       {"it's $HOME; \"`x`\" \\ a  b", "", "*", "~", "a=[0, -1, 0]", "#a", "{a,b}", "out/a=2.5_b-c+d"}) {
    ASSERT_EQ(std::system(("printf %s " + shellWord(odd) + " >" + (scratch / "said")).c_str()), 0);
    EXPECT_EQ(apps::test::contentsOf(scratch / "said"), odd);
  }
}

TEST(ShellWord, IsQuotedOnlyWhereItMustBe) {
  EXPECT_EQ(shellWord("out/look/commands.sh"), "out/look/commands.sh");
  EXPECT_EQ(shellWord("a b"), "'a b'");
  EXPECT_EQ(shellWord(""), "''");
}

/// A run that was stopped before its first step, or whose statistics somebody took away.
TEST(WedgeSummary, ARunWithoutStatisticsHasItsStatusAlone) {
  const apps::test::Scratch scratch;
  scratch.write("wedge.csv", "folder,liquid.cfl\na,1\nb,2\nc,3\n");
  for (const char* folder : {"a", "b"}) {
    std::filesystem::create_directories(scratch / folder);
    scratch.write(std::string(folder) + "/run.json", "{\n  \"status\": \"stopped\"\n}\n");
  }
  scratch.write("b/steps.csv", "");
  const WedgeSummary summary = summarize(scratch / "");
  ASSERT_EQ(summary.variants.size(), 3u);
  EXPECT_EQ(summary.variants[0].status, "stopped");
  EXPECT_EQ(summary.variants[1].status, "stopped");
  EXPECT_EQ(summary.variants[2].status, "not begun");
  for (const VariantSummary& variant : summary.variants) EXPECT_EQ(variant.frames, 0);
}

}  // namespace
}  // namespace spume::apps
