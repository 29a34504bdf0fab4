#include "apps/trade/trade_plot.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "apps/reproduce/svg_plot.h"

namespace spume::apps {
namespace {

/// What a panel shows of a run.
using Height = std::function<double(const TradeRun&)>;

double distance(const Trade& trade, const TradeRun& run) {
  double squares = 0, figures = 0;
  for (std::size_t k = 0; k < kTradeFigures.size(); ++k) {
    if (kTradeFigures[k].isError) continue;
    const double difference = run.figures.values[k] - trade.reference.figures.values[k];
    squares += std::pow(trade.inTolerances(difference, k), 2);
    ++figures;
  }
  return std::sqrt(squares / figures);
}

Curve curveOf(const Trade& trade, const TradeSweep& sweep, const Height& height) {
  std::vector<std::pair<double, double>> points;
  const auto add = [&](const TradeRun& run) {
    if (run.failure.empty()) points.emplace_back(run.figures.cost.seconds, height(run));
  };
  add(trade.mean());
  for (const TradeRun& run : sweep.runs) add(run);
  std::sort(points.begin(), points.end());
  Curve curve{sweep.dial.name, {}, {}, true};
  for (const auto& [seconds, high] : points) curve.x.push_back(seconds), curve.y.push_back(high);
  return curve;
}

/// A panel with the dials of a kind; left out if there are none.
void addPanel(const Trade& trade, DialKind kind, Plot panel, const Height& height,
              std::vector<Plot>& panels) {
  for (const TradeSweep& sweep : trade.sweeps)
    if (sweep.dial.kind == kind) panel.curves.push_back(curveOf(trade, sweep, height));
  if (!panel.curves.empty()) panels.push_back(std::move(panel));
}

}  // namespace

std::string tradePlot(const Trade& trade) {
  const std::string time = "time of a frame [s]", away = "from the reference [noise]";
  const Height figures = [&](const TradeRun& run) { return distance(trade, run); };
  const auto figure = [](std::size_t k) {
    return [k](const TradeRun& run) { return run.figures.values[k]; };
  };
  std::vector<Plot> panels;
  addPanel(trade, DialKind::liquid, {"Dials of the liquid", time, away, {}}, figures, panels);
  addPanel(trade, DialKind::liquid, {"Volume of the liquid off, worst frame", time, "[%]", {}, true},
           figure(kLiquidOff), panels);
  addPanel(trade, DialKind::foam, {"Dials of the foam", time, away, {}}, figures, panels);
  addPanel(trade, DialKind::foam, {"Volume of a cell off, worst late frame", time, "[%]", {}, true},
           figure(kCellsOff), panels);
  return svgOf(panels);
}

}  // namespace spume::apps
