#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <set>

#include "apps/trade/trade.h"
#include "apps/trade/trade_page.h"
#include "apps/trade/trade_plot.h"
#include "apps/trade/trade_readings.h"
#include "apps/trade/trade_table.h"
#include "coupling/scene_toml.h"

namespace spume::apps {
namespace {

std::vector<std::string> shippedScenes() {
  std::vector<std::string> paths;
  for (const auto& entry : std::filesystem::directory_iterator(SPUME_SOURCE_DIR "/data/scenes"))
    if (entry.path().extension() == ".toml") paths.push_back(entry.path().string());
  return paths;
}

const Dial& dialCalled(const std::vector<Dial>& dials, const std::string& name) {
  for (const Dial& dial : dials)
    if (dial.name == name) return dial;
  throw std::out_of_range(name);
}

TEST(TradeDials, EverySettingIsLegalInEveryShippedScene) {
  ASSERT_GT(shippedScenes().size(), 5u);
  for (const std::string& path : shippedScenes())
    for (const Dial& dial : dialsOf(coupling::readScene(path))) {
      ASSERT_FALSE(dial.settings.empty()) << dial.name;
      for (const DialSetting& setting : dial.settings)
        EXPECT_NO_THROW(coupling::readScene(path, setting.overrides)) << path << ' ' << dial.name;
    }
}

TEST(TradeDials, EveryDialTurnsAndEveryTermSwitchesTheSceneItself) {
  for (const std::string& path : shippedScenes()) {
    const coupling::Scene scene = coupling::readScene(path);
    const std::string own = coupling::writeScene(scene);
    std::set<std::string> names;
    for (const Dial& dial : dialsOf(scene)) {
      EXPECT_TRUE(names.insert(dial.name).second) << dial.name << " twice";
      std::set<std::string> scenes;
      for (const DialSetting& setting : dial.settings)
        scenes.insert(coupling::writeScene(coupling::readScene(path, setting.overrides)));
      EXPECT_EQ(scenes.size(), dial.settings.size()) << path << ' ' << dial.name << ": settings are the same";
      EXPECT_TRUE(dial.kind != DialKind::term || scenes.count(own) == 0) << path << ' ' << dial.name;
    }
  }
}

TEST(TradeDials, AreThoseThatDoSomething) {
  const auto soap = dialsOf(coupling::readScene(SPUME_SOURCE_DIR "/data/scenes/soap.toml"));
  EXPECT_THROW(dialCalled(soap, "cfl"), std::out_of_range) << "the water of a pool at rest has no dials";
  EXPECT_THROW(dialCalled(soap, "two_way"), std::out_of_range);
  EXPECT_NO_THROW(dialCalled(soap, "borders"));
  const auto coke = dialsOf(coupling::readScene(SPUME_SOURCE_DIR "/data/scenes/coke.toml"));
  EXPECT_THROW(dialCalled(coke, "borders"), std::out_of_range);
  for (const char* name : {"cfl", "attraction", "holding", "dissolved_gas", "two_way"})
    EXPECT_NO_THROW(dialCalled(coke, name)) << name;
  EXPECT_EQ(dialCalled(coke, "two_way").settings.front().label, "off");
  const auto pouring = dialsOf(coupling::readScene(SPUME_SOURCE_DIR "/data/scenes/pouring.toml"));
  EXPECT_EQ(dialCalled(pouring, "two_way").settings.front().label, "on");
}

TEST(TradeDials, OfALiquidOfAnEarlierRunAreThoseOfTheFoam) {
  coupling::Scene scene = coupling::readScene(SPUME_SOURCE_DIR "/data/scenes/pouring.toml");
  ASSERT_NO_THROW(dialCalled(dialsOf(scene), "pressure_gradient"));
  scene.liquidCache.run = "out/pouring";
  const auto dials = dialsOf(scene);
  for (const char* name : {"resolution", "cfl", "two_way", "volume_control", "pressure_gradient"})
    EXPECT_THROW(dialCalled(dials, name), std::out_of_range) << name;
  for (const char* name : {"solver", "step", "drag"}) EXPECT_NO_THROW(dialCalled(dials, name)) << name;
}

TEST(TradeDials, TermsThatGiveWayToOthersAreNotCalledOff) {
  const auto soap = dialsOf(coupling::readScene(SPUME_SOURCE_DIR "/data/scenes/soap.toml"));
  EXPECT_EQ(dialCalled(soap, "dirt").settings.front().label, "clean");
  EXPECT_EQ(dialCalled(soap, "dry_aloft").settings.front().label, "one wetness");
  EXPECT_EQ(dialCalled(soap, "drag").settings.front().label, "off");
}

TEST(TradeDials, TheReferenceIsTheLastSettingOfEach) {
  const std::string path = SPUME_SOURCE_DIR "/data/scenes/pouring.toml";
  const coupling::Scene finest = coupling::readScene(path, finestOf(dialsOf(coupling::readScene(path))));
  EXPECT_EQ(finest.liquid.cfl, 1);
  EXPECT_EQ(finest.domain.resolution, 96);
  EXPECT_EQ(finest.time.maxDt, 0.005);
  EXPECT_EQ(finest.time.minDt, 0.005);
  EXPECT_EQ(finest.foam.volumeMode, foam::VolumeMode::newton);
  EXPECT_EQ(finest.foam.volumeTolerance, 1e-4);
  EXPECT_GT(finest.foam.addedMass, 0) << "terms stay";
}

TEST(TradeDials, AreChosenByNameOrGroup) {
  const auto all = dialsOf(coupling::readScene(SPUME_SOURCE_DIR "/data/scenes/pouring.toml"));
  EXPECT_EQ(selectDials(all, {}).size(), all.size());
  EXPECT_EQ(selectDials(all, {"liquid", "foam", "terms"}).size(), all.size());
  const auto two = selectDials(all, {"step", "cfl"});
  ASSERT_EQ(two.size(), 2u);
  EXPECT_EQ(two[0].name, "cfl");
  try {
    selectDials(all, {"clf"});
    FAIL();
  } catch (const coupling::SceneError& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean cfl?"), std::string::npos) << error.what();
  }
}

TEST(TradeNoise, IsThePredictionBandOfStudentsT) {
  const double kTabled = 1e-3;  // relative: Student's t is tabled to so many digits
  const Noise two = noiseOf({1, 3}), three = noiseOf({2, 1, 3});
  EXPECT_DOUBLE_EQ(two.mean, 2);
  EXPECT_NEAR(two.band, 63.657 * std::sqrt(1.5) * std::sqrt(2.0), kTabled * two.band);
  EXPECT_DOUBLE_EQ(three.mean, 2);
  EXPECT_NEAR(three.band, 9.925 * std::sqrt(4.0 / 3), kTabled * three.band);
  EXPECT_EQ(noiseOf({5, 5, 5, 5}).band, 0);
}

TradeRun runWith(double bubbles, double seconds = 1) {
  TradeRun run{"off", {}};
  run.figures.values[0] = bubbles;
  run.figures.cost.seconds = seconds;
  return run;
}

TradeSweep sweepOf(const std::string& name, DialKind kind, const TradeRun& run) {
  return {{name, name + "'s title", kind, {{run.label, {}}}}, {run}};
}

/// Own runs of 98, 100 and 102 bubbles: a band of 2 x 9.925 sqrt(4/3) = 22.9.
Trade madeUp() {
  Trade trade;
  trade.own = {runWith(98), runWith(100), runWith(102)};
  trade.reference = runWith(110, 10);
  trade.sweeps = {sweepOf("idle", DialKind::term, runWith(122)),
                  sweepOf("vital", DialKind::term, runWith(124)),
                  sweepOf("other", DialKind::term, runWith(78)),
                  sweepOf("quick", DialKind::foam, runWith(100, 0.5)),
                  sweepOf("slow", DialKind::foam, runWith(100, 0.99)),
                  sweepOf("rough", DialKind::liquid, runWith(70, 0.5))};
  return trade;
}

TEST(Trade, TellsTermsThatChangeNothingFromThoseThatDo) {
  EXPECT_EQ(termsWithoutEffect(madeUp()), (std::vector<std::string>{"idle", "other"}));
  EXPECT_EQ(idleTerms(madeUp()), "idle's title, other's title");
  EXPECT_EQ(neededTerms(madeUp()), "vital's title: off (bubbles alive +24.0 %)");
  EXPECT_EQ(quickerSettings(madeUp()), "quick's title off (0.50 of the time)");
}

TEST(Trade, ASettingIsQuickerBeyondTheNoiseOfTimesOnly) {
  Trade trade = madeUp();
  trade.own[0].figures.cost.seconds = 0.98, trade.own[2].figures.cost.seconds = 1.02;
  EXPECT_EQ(quickerSettings(trade), "quick's title off (0.50 of the time)");
  trade.own[0].figures.cost.seconds = 0.95, trade.own[2].figures.cost.seconds = 1.05;  // a band of 0.57
  EXPECT_EQ(quickerSettings(trade), "none");
}

TEST(TradePlot, RunsOfADialAreDotsAndFailedOnesAreNot) {
  Trade trade = madeUp();
  const auto dots = [](const std::string& svg) {
    std::size_t found = 0;
    for (std::size_t at = 0; (at = svg.find("<circle", at)) != std::string::npos; ++at) ++found;
    return found;
  };
  trade.sweeps.back().runs.front().figures.values[kLiquidOff] = 1;
  trade.own.front().figures.values[kLiquidOff] = 3;
  const std::size_t whole = dots(tradePlot(trade));
  EXPECT_EQ(whole, 2u * 2 + 1 * 2 + 1 * 2) << "two dials of the foam, one of the liquid and its volume";
  trade.sweeps.back().runs.front().failure = "diverged: NaN";
  EXPECT_EQ(dots(tradePlot(trade)), whole - 2);
}

TEST(Trade, ADivergedRunIsNeitherWithoutEffectNorQuick) {
  Trade trade = madeUp();
  for (TradeSweep& sweep : trade.sweeps) sweep.runs.front().failure = "diverged: NaN";
  EXPECT_TRUE(termsWithoutEffect(trade).empty());
  EXPECT_EQ(quickerSettings(trade), "none");
  EXPECT_NE(neededTerms(trade).find("idle's title: off (diverged)"), std::string::npos);
  EXPECT_NE(tradePage(trade, "p.svg", "c").find("| quick's title | off | diverged |"), std::string::npos);
}

TEST(Trade, DifferencesNobodySeesCountAsNone) {
  Trade trade;
  trade.own = {runWith(1000), runWith(1000)};  // no noise at all
  EXPECT_TRUE(trade.within(runWith(1010), 0));
  EXPECT_FALSE(trade.within(runWith(1011), 0));
}

/// What is nothing in every run, as without bubbles, is no distance: neither in words nor in the plot.
TEST(Trade, NothingOfNothingIsNoDistance) {
  Trade trade;
  trade.own = {runWith(0), runWith(0)};
  EXPECT_EQ(trade.tolerance(0), 0);
  EXPECT_EQ(trade.inTolerances(0, 0), 0);
  EXPECT_DOUBLE_EQ(trade.inTolerances(0.3, kLiquidOff), 3);
  TradeRun drifts = runWith(0);
  drifts.figures.values[kLiquidOff] = 0.3;
  trade.sweeps = {sweepOf("control", DialKind::term, drifts), sweepOf("fine", DialKind::foam, runWith(0))};
  EXPECT_EQ(neededTerms(trade), "control's title: off (liquid off, worst frame +0.30)");
  EXPECT_EQ(tradePlot(trade).find("nan"), std::string::npos);
}

/// Without drag it does not matter whose law it followed: what switches all at once leaves none of it.
TEST(Trade, TermsThatSetTheSameKeyGoTogether) {
  const std::string path = SPUME_SOURCE_DIR "/data/scenes/pouring.toml";
  Trade trade;
  trade.own = {runWith(100), runWith(100)};
  for (const Dial& dial : dialsOf(coupling::readScene(path)))
    if (dial.name == "drag" || dial.name == "dirt") trade.sweeps.push_back({dial, {runWith(100)}});
  ASSERT_EQ(trade.sweeps.size(), 2u);
  const coupling::Scene without = coupling::readScene(path, allWithoutEffect(trade));
  EXPECT_EQ(without.foam.dragLaw, foam::DragLaw::coefficient);
  EXPECT_EQ(without.foam.dragCoefficient, 0);
}

TEST(Trade, AReferenceTheSceneDoesNotAllowIsRefusedBeforeAnythingRuns) {
  const std::string path = SPUME_SOURCE_DIR "/data/scenes/pouring.toml";
  const TradePlan plan{
      [&](coupling::Overrides changes) {
        changes.insert(changes.begin(), {"domain.resolution", "700"});  // 1050 are more than there may be
        return coupling::readScene(path, changes);
      },
      {},
      2};
  StudyContext context;
  int runs = 0;
  context.runScene = [&](const coupling::Scene&, const std::string&) { ++runs; };
  EXPECT_THROW(runTrade(plan, context), coupling::SceneError);
  EXPECT_EQ(runs, 0);
}

TEST(TradeTable, ARunThatDidNotGetToItsEndHasNoFigures) {
  Trade trade = madeUp();
  trade.sweeps.resize(1);
  trade.sweeps.front().runs.front().failure = "diverged: NaN";
  const ResultTable table = tradeTable(trade);
  std::size_t rows = 0;
  for (const ResultRow& row : table.rows()) {
    const bool failed = row.study == "idle";
    EXPECT_EQ(std::isnan(row.figure), failed) << row.study << ' ' << row.quantity;
    EXPECT_EQ(std::isnan(row.seconds), failed) << row.study << ' ' << row.quantity;
    rows += failed;
  }
  EXPECT_GT(rows, kTradeFigures.size()) << "times and iterations, too";
}

TEST(TradeTable, RowsAimAtTheBandOfTheScenesOwnRuns) {
  const ResultTable table = tradeTable(madeUp());
  std::size_t judged = 0;
  for (const ResultRow& row : table.rows()) {
    if (row.quantity != "bubbles alive") continue;
    const bool isBase = row.study == "own" || row.study == "reference";
    const bool isOff = row.study == "vital" || row.study == "rough";
    EXPECT_EQ(row.verdict, isBase ? Verdict::none : isOff ? Verdict::missed : Verdict::met) << row.study;
    EXPECT_EQ(row.reference, "110");
    judged += !isBase;
  }
  EXPECT_EQ(judged, 6u);
}

TEST(TradePage, TheReferenceDiffersNotFromItself) {
  const std::string page = tradePage(madeUp(), "p.svg", "c");
  const std::size_t start = page.find("| reference | finest | 10 |");
  ASSERT_NE(start, std::string::npos) << page;
  const std::string row = page.substr(start, page.find('\n', start) - start);
  EXPECT_NE(row.find("+0.0 %"), std::string::npos) << row;
  EXPECT_EQ(row.find_first_of("123456789", row.find("| 10 |") + 6), std::string::npos) << row;
  EXPECT_NE(page.find("**-36.4 %**"), std::string::npos) << "rough: 70 against 110 is bold; " << page;
}

/// In both tables, although the dials' base lies elsewhere than the mean of the scene's own runs.
TEST(TradePage, BoldIsTheDifferenceItMarks) {
  Trade trade = madeUp();
  trade.reference = runWith(130, 10);  // the band is 22.9
  const std::string page = tradePage(trade, "p.svg", "c");
  const auto firstFigure = [&](const std::string& start) {
    std::size_t at = page.find(start);
    if (at == std::string::npos) return start + " is not there";
    for (int bar = 0; bar < 8; ++bar) at = page.find('|', at) + 1;
    return page.substr(at, page.find('|', at) - at);
  };
  EXPECT_EQ(firstFigure("| reference | finest |"), " +0.0 % ");
  EXPECT_EQ(firstFigure("| scene | own |"), " **-23.1 %** ");
  EXPECT_EQ(firstFigure("| quick's title | off |"), " **-23.1 %** ");
  EXPECT_EQ(firstFigure("| idle's title | off |"), " +22.0 % ");
  EXPECT_EQ(firstFigure("| vital's title | off |"), " **+24.0 %** ");
}

TEST(TradePage, AReadingIsKept) {
  const std::string page = tradePage(madeUp(), "p.svg", "c");
  EXPECT_EQ(readingOf(page), "");
  const std::string reading = "Reading: more\nthan one line, `code`.";
  const std::string read = tradePage(madeUp(), "p.svg", "c", reading);
  EXPECT_EQ(readingOf(read), reading);
  EXPECT_EQ(tradePage(madeUp(), "p.svg", "c", readingOf(read)), read);
  EXPECT_EQ(readingOf(page + "\nReading: last\n"), "Reading: last");
  EXPECT_EQ(readingOf("A word on Reading: none.\n"), "");
}

}  // namespace
}  // namespace spume::apps
