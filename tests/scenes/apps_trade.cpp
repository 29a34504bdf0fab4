#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "apps/reproduce/result_table.h"
#include "apps/trade/trade_figures.h"
#include "tests/support/apps_program.h"
#include "tests/support/pouring_scene.h"

namespace spume::apps::test {
namespace {

/// Bubbles blown into a pool at rest: births do not depend on how finely the foam is computed. They never
/// burst, so that `bursting` is a term without effect. The scene asks for no cache of bubbles: figures are
/// taken from one all the same.
const std::string kFroth =
    "[domain]\nsize = [0.06, 0.08, 0.06]\nresolution = 16\n"
    "[still_pool]\nenabled = true\nlevel = 0.03\n"
    "[output]\nbubbles_ply = false\n"
    "[coupling.entrainment]\nenabled = false\n"
    "[foam]\nvolume_mode = \"newton\"\nburst_median_life = 1e9\n"
    "[[bubble_source]]\nname = \"frit\"\nshape = \"box\"\nlower = [0.01, 0.005, 0.01]\n"
    "upper = [0.05, 0.015, 0.05]\nrate = 150\nmedian_radius = 3e-3\nmin_radius = 2e-3\nmax_radius = 5e-3\n";

/// Figures of a table: (study, title, quantity) -> row.
using Rows = std::map<std::string, ResultRow>;

Rows readRows(const std::string& path) {
  ResultTable table("");
  table.readCsv(contentsOf(path), path);
  Rows rows;
  for (const ResultRow& row : table.rows()) rows[row.study + "|" + row.title + "|" + row.quantity] = row;
  return rows;
}

/// A finished trade and what its table says.
struct Finished {
  Rows rows;
  std::string page;

  const ResultRow& row(const std::string& key) const { return rows.at(key); }
};

void expectIterationsGrowWithAccuracy(const Finished& trade) {
  const std::string dial = "solver|tolerance of the implicit step: ",
                    iterations = "|iterations of the implicit step a frame";
  const double loose = trade.row(dial + "1e-2" + iterations).figure,
               middle = trade.row(dial + "1e-4" + iterations).figure,
               tight = trade.row(dial + "1e-8" + iterations).figure;
  EXPECT_GT(loose, 0);
  EXPECT_LE(loose, middle);
  EXPECT_LT(middle, tight);
  EXPECT_EQ(trade.rows.count(dial + "1e-5" + iterations), 0u) << "the scene's own setting is no variant";
}

void expectVolumesHeldByTheirCorrectionAlone(const Finished& trade) {
  const std::string quantity = "|cell volume off, worst late frame";
  const ResultRow& off = trade.row("volume_correction|correction of the cells' volumes: off" + quantity);
  const double kTolerance = 0.1;  // of foam.volume_tolerance by default [%]
  EXPECT_LE(trade.row("own|seed 1" + quantity).figure, kTolerance);
  EXPECT_GT(off.figure, 10 * kTolerance);
  EXPECT_EQ(off.verdict, Verdict::missed);
}

/// Nothing bursts in the scene: without bursting its run is the same to the bit.
void expectBurstingIsIdle(const Finished& trade) {
  for (const TradeFigure& figure : kTradeFigures) {
    const ResultRow& off = trade.row(std::string("bursting|bursting: off|") + figure.name);
    EXPECT_EQ(off.figure, trade.row(std::string("own|seed 1|") + figure.name).figure) << figure.name;
    EXPECT_EQ(off.verdict, Verdict::met) << figure.name;
  }
  const std::size_t line = trade.page.find("* Terms this scene does not need");
  ASSERT_NE(line, std::string::npos);
  const std::string idle = trade.page.substr(line, trade.page.find('\n', line) - line);
  EXPECT_NE(idle.find("bursting"), std::string::npos) << idle;
  EXPECT_EQ(idle.find("correction"), std::string::npos) << idle;
}

/// The same figure from another file of the run.
void expectBirthsAreThoseOfTheEvents(const Finished& trade, const std::string& path) {
  const std::string events = contentsOf(path);
  std::size_t births = 0;
  for (std::size_t at = 0; (at = events.find(",birth,", at)) != std::string::npos; ++at) ++births;
  EXPECT_GT(births, 50u);
  EXPECT_EQ(trade.row("own|seed 1|births").figure, static_cast<double>(births));
}

TEST(TradeRun, SaysWhatIsKnownOfAFrothAndRunAgainTheSame) {
  const Scratch scratch;
  const std::string command = "trade " + scratch.write("froth.toml", kFroth) +
                              " --frames 20 --seeds 3 --dials solver,bursting,volume_correction -o " +
                              (scratch / "t") + " --runs " + (scratch / "runs");
  const Outcome outcome = runSpume(command);
  ASSERT_EQ(outcome.code, 0) << outcome.errors;
  const Finished trade{readRows(scratch / "t/trade_froth.csv"), contentsOf(scratch / "t/trade_froth.md")};
  expectIterationsGrowWithAccuracy(trade);
  expectVolumesHeldByTheirCorrectionAlone(trade);
  expectBurstingIsIdle(trade);
  expectBirthsAreThoseOfTheEvents(trade, scratch / "runs/froth/seed=1/events.csv");
  EXPECT_GT(trade.row("own|seed 1|mean height of the gas").figure, 0);
  EXPECT_EQ(contentsOf(scratch / "t/trade_froth.svg").rfind("<svg", 0), 0u);

  const std::string reading = "Reading: nothing bursts.\n\n", title = "# Speed against accuracy: froth\n\n";
  ASSERT_EQ(trade.page.rfind(title, 0), 0u);
  const std::string page = std::string(trade.page).insert(title.size(), reading);
  scratch.write("t/trade_froth.md", page);
  const Outcome again = runSpume(command);
  EXPECT_EQ(again.code, 0) << again.errors;
  EXPECT_EQ(again.output.find("frame 1/"), std::string::npos) << "finished runs are not run again";
  EXPECT_EQ(contentsOf(scratch / "t/trade_froth.md"), page);
}

TEST(TradeRun, ASettingTheSceneCannotHaveIsNoted) {
  const Scratch scratch;  // 10 cells instead of 16 are too coarse for a nozzle of 8 mm near a wall
  const Outcome outcome =
      runSpume("trade " + scratch.write("pour.toml", kPour) +
               " --set inflow.0.radius=0.004 --set 'inflow.0.direction=[0, -1, 0]' --frames 1 --seeds 2"
               " --dials resolution -o " +
               (scratch / "t") + " --runs " + (scratch / "runs"));
  ASSERT_EQ(outcome.code, 0) << outcome.errors;
  const std::string page = contentsOf(scratch / "t/trade_pour.md");
  EXPECT_NE(page.find("| cells along an edge | 10 | refused |"), std::string::npos) << page;
  const Rows rows = readRows(scratch / "t/trade_pour.csv");
  const ResultRow& row = rows.at("resolution|cells along an edge: 10|births");
  EXPECT_EQ(row.verdict, Verdict::missed);
  EXPECT_NE(row.note.find("inflow 'jet'"), std::string::npos) << row.note;
  EXPECT_TRUE(std::isnan(rows.at("resolution|cells along an edge: 10|time of a frame").figure));
  EXPECT_NE(
      page.find("--frames 1 --set inflow.0.radius=0.004 --set 'inflow.0.direction=[0, -1, 0]' --seeds 2 "
                "--dials resolution`"),
      std::string::npos)
      << "a shell takes it as it was typed: " << page;
}

}  // namespace
}  // namespace spume::apps::test
