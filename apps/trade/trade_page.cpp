#include "apps/trade/trade_page.h"

#include <cmath>

#include "apps/trade/trade_readings.h"
#include "apps/trade/trade_text.h"

namespace spume::apps {
namespace {

std::string bold(const std::string& text, bool isBold) { return isBold ? "**" + text + "**" : text; }

std::string costCells(const TradeCost& cost) {
  return number(" | %.3g", cost.seconds) + number(" | %.3g", cost.liquidSeconds) +
         number(" | %.3g", cost.foamSeconds) + number(" | %.0f", cost.pressureIterations) +
         number(" | %.0f", cost.foamIterations);
}

std::string tableHead() {
  std::string names = "| | setting | s a frame | liquid | foam | pressure it. | foam it. |",
              lines = "|---|---|";
  for (int n = 0; n < 5; ++n) lines += "---|";
  for (const TradeFigure& figure : kTradeFigures) {
    names += std::string(" ") + figure.name + (isShare(figure) ? "" : " [points]") + " |";
    lines += "---|";
  }
  return names + "\n" + lines + "\n";
}

/// A row of differences from `base`.
std::string row(const Trade& trade, const std::string& title, const TradeRun& run, const TradeRun& base) {
  std::string text = "| " + title + " | " + run.label;
  if (!run.failure.empty()) return text + " | " + run.failureWord() + " |\n";
  text += costCells(run.figures.cost);
  for (std::size_t k = 0; k < kTradeFigures.size(); ++k) {
    const double of = base.figures.values[k], difference = run.figures.values[k] - of;
    text += " | " + bold(differenceText(k, difference, of), std::abs(difference) > trade.tolerance(k));
  }
  return text + " |\n";
}

/// The scene's own runs: the mean of the figures themselves, and how far other seeds scatter.
std::string ownRows(const Trade& trade, const TradeRun& own) {
  std::string values = "| figures | own", bands = "| noise | +-";
  values += costCells(own.figures.cost);
  bands += number(" | %.2g", trade.seconds().band) + " | | | | |";
  for (std::size_t k = 0; k < kTradeFigures.size(); ++k) {
    const std::string unit = kTradeFigures[k].unit;
    values += number(" | %.4g", own.figures.values[k]) + (unit.empty() ? "" : " " + unit);
    const std::string band = differenceText(k, trade.tolerance(k), std::abs(own.figures.values[k])).substr(1);
    bands += (k ? " | " : " ") + band;
  }
  return values + " |\n" + bands + " |\n";
}

std::string table(const Trade& trade, bool terms) {
  const TradeRun own = trade.mean();
  const TradeRun& base = terms ? own : trade.reference;
  std::string text = tableHead() + ownRows(trade, own);
  if (!terms) {
    text += row(trade, "reference", {"finest", trade.reference.figures}, base);
    text += row(trade, "scene", own, base);
  }
  for (const TradeSweep& sweep : trade.sweeps)
    if ((sweep.dial.kind == DialKind::term) == terms)
      for (const TradeRun& run : sweep.runs) text += row(trade, sweep.dial.title, run, base);
  return text;
}

}  // namespace

std::string tradePage(const Trade& trade, const std::string& plot, const std::string& command,
                      const std::string& reading) {
  const double own = trade.seconds().mean;
  std::string text =
      "# Speed against accuracy: " + trade.scene.name + "\n\n" + (reading.empty() ? "" : reading + "\n\n") +
      "`" + command + "`: " + lengthOf(trade) + ". The scene's own settings take " + number("%.3g", own) +
      " s a frame, the reference, every dial at its finest, " +
      number("%.3g", trade.reference.figures.cost.seconds) + " s.\n\n" +
      "* Quicker, and no figure beyond the noise of the scene's own: " + quickerSettings(trade) + ".\n" +
      "* Terms this scene does not need, for these figures at this length: " + idleTerms(trade) +
      ".\n* Terms it needs: " + neededTerms(trade) + ".\n\n";
  text +=
      "Bold: larger than the noise, the difference from the mean of the scene's own " +
      std::to_string(trade.own.size()) +
      " seeds that a further seed exceeds once in a hundred runs, and enough to be seen (1 %; 0.1 or 1 "
      "points of a percentage). A figure of many is bold by chance now and then.\n\n## Dials: differences "
      "from the reference\n\n";
  text += table(trade, false);
  text +=
      "\n![distance from the reference over time](" + plot +
      ")\n*Distance of the scene's figures from the reference's, root of their mean square in widths of the "
      "noise, and the errors of volumes, over the time of a frame. Every "
      "curve goes through the scene's own settings.*\n\n## Terms: differences from the scene's own "
      "settings\n\n";
  return text + table(trade, true);
}

std::string readingOf(const std::string& page) {
  const std::size_t start = ("\n\n" + page).find("\n\nReading:");
  if (start == std::string::npos) return {};
  const std::string paragraph = page.substr(start, page.find("\n\n", start) - start);
  return paragraph.substr(0, paragraph.find_last_not_of('\n') + 1);
}

}  // namespace spume::apps
