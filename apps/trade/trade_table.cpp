#include "apps/trade/trade_table.h"

#include <cmath>
#include <tuple>

#include "apps/trade/trade_text.h"

namespace spume::apps {
namespace {

/// What the rows of a run are called.
struct RowNames {
  std::string study, title;
};

/// A number of a run: NaN, which misses every aim, of one that did not get to its end.
double orNan(const TradeRun& run, double value) { return run.failure.empty() ? value : std::nan(""); }

ResultRow rowOf(const Trade& trade, const RowNames& names, const TradeRun& run, const std::string& quantity) {
  ResultRow row;
  row.study = names.study;
  row.title = names.title;
  row.resolution = lengthOf(trade);
  row.quantity = quantity;
  row.seconds = orNan(run, run.figures.cost.seconds * trade.scene.time.frames);
  row.note = run.failure;
  return row;
}

void addCost(const Trade& trade, const RowNames& names, const TradeRun& run, std::vector<ResultRow>& rows) {
  const TradeCost& cost = run.figures.cost;
  for (const auto& [name, value, unit] :
       {std::tuple{"time of a frame", cost.seconds, "s"},
        {"of it the liquid", cost.liquidSeconds, "s"},
        {"of it the foam", cost.foamSeconds, "s"},
        {"iterations of the pressure a frame", cost.pressureIterations, ""},
        {"iterations of the implicit step a frame", cost.foamIterations, ""}}) {
    ResultRow row = rowOf(trade, names, run, name);
    rows.push_back(reportOnly(row, orNan(run, value), unit));
  }
}

/// `judged`: aims at the band of the scene's own runs.
void addRows(const Trade& trade, const RowNames& names, const TradeRun& run, bool judged,
             std::vector<ResultRow>& rows) {
  for (std::size_t k = 0; k < kTradeFigures.size(); ++k) {
    ResultRow row = rowOf(trade, names, run, kTradeFigures[k].name);
    const std::string unit = kTradeFigures[k].unit;
    row.reference = number("%.6g", trade.reference.figures.values[k]) + (unit.empty() ? "" : " " + unit);
    row.source = "every dial at its finest";
    const double value = orNan(run, run.figures.values[k]);
    const double mean = trade.noise(k).mean, band = trade.tolerance(k);
    rows.push_back(judged ? aimWithin(row, value, mean - band, mean + band, unit)
                          : reportOnly(row, value, unit));
  }
  addCost(trade, names, run, rows);
}

}  // namespace

ResultTable tradeTable(const Trade& trade) {
  ResultTable table("Speed against accuracy: " + trade.scene.name);
  std::vector<ResultRow> rows;
  addRows(trade, {"reference", "every dial at its finest"}, trade.reference, false, rows);
  table.set("reference", rows);
  rows.clear();
  for (const TradeRun& run : trade.own) addRows(trade, {"own", run.label}, run, false, rows);
  table.set("own", rows);
  for (const TradeSweep& sweep : trade.sweeps) {
    rows.clear();
    for (const TradeRun& run : sweep.runs)
      addRows(trade, {sweep.dial.name, sweep.dial.title + ": " + run.label}, run, true, rows);
    table.set(sweep.dial.name, rows);
  }
  return table;
}

}  // namespace spume::apps
