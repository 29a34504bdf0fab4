#include "apps/trade/trade_plot.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "apps/reproduce/svg_plot.h"

namespace spume::apps {
namespace {

/// Largest distance of a figure from the reference's, in tolerances.
double distance(const Trade& trade, const TradeRun& run) {
  double largest = 0;
  for (std::size_t k = 0; k < kTradeFigures.size(); ++k)
    largest = std::max(
        largest, std::abs(run.figures.values[k] - trade.reference.figures.values[k]) / trade.tolerance(k));
  return largest;
}

Curve curveOf(const Trade& trade, const TradeSweep& sweep) {
  std::vector<std::pair<double, double>> points;
  const auto add = [&](const TradeRun& run) {
    if (run.failure.empty()) points.emplace_back(run.figures.cost.seconds, distance(trade, run));
  };
  add(trade.mean());
  for (const TradeRun& run : sweep.runs) add(run);
  std::sort(points.begin(), points.end());
  Curve curve{sweep.dial.name, {}, {}, true};
  for (const auto& [seconds, away] : points) curve.x.push_back(seconds), curve.y.push_back(away);
  return curve;
}

}  // namespace

std::string tradePlot(const Trade& trade) {
  std::vector<Plot> panels;
  for (const auto& [kind, title] :
       {std::pair{DialKind::liquid, "Dials of the liquid"}, {DialKind::foam, "Dials of the foam"}}) {
    Plot plot{title, "time of a frame [s]", "from the reference [noise]", {}};
    for (const TradeSweep& sweep : trade.sweeps)
      if (sweep.dial.kind == kind) plot.curves.push_back(curveOf(trade, sweep));
    if (!plot.curves.empty()) panels.push_back(std::move(plot));
  }
  return svgOf(panels);
}

}  // namespace spume::apps
