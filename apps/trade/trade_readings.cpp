#include "apps/trade/trade_readings.h"

#include <algorithm>
#include <cmath>

#include "apps/trade/trade_text.h"

namespace spume::apps {
namespace {

/// A setting saves time if it takes less than this share of the scene's own [-].
constexpr double kQuicker = 0.95;

std::string joined(const std::vector<std::string>& parts) {
  std::string text;
  for (const std::string& part : parts) text.append(text.empty() ? "" : ", ").append(part);
  return text.empty() ? "none" : text;
}

/// The figure a run moves furthest, in tolerances, and how far.
std::string furthest(const Trade& trade, const TradeRun& run) {
  if (!run.failure.empty()) return run.failureWord();
  std::size_t most = 0;
  const auto moved = [&](std::size_t k) { return run.figures.values[k] - trade.noise(k).mean; };
  for (std::size_t k = 1; k < kTradeFigures.size(); ++k)
    if (std::abs(trade.inTolerances(moved(k), k)) > std::abs(trade.inTolerances(moved(most), most))) most = k;
  return std::string(kTradeFigures[most].name) + " " +
         differenceText(most, moved(most), trade.noise(most).mean);
}

/// What came of switching all terms without effect at once; empty if that was not run.
std::string together(const Trade& trade) {
  if (trade.sweeps.empty() || trade.sweeps.back().dial.name != kAllTogether) return {};
  const TradeRun& run = trade.sweeps.back().runs.front();
  return trade.allWithin(run) ? "; nor all of them at once"
                              : "; but all of them at once: " + furthest(trade, run);
}

}  // namespace

std::string quickerSettings(const Trade& trade) {
  const Noise own = trade.seconds();
  std::vector<std::string> found;
  for (const TradeSweep& sweep : trade.sweeps)
    for (const TradeRun& run : sweep.runs)
      if (sweep.dial.kind != DialKind::term && trade.allWithin(run) &&
          run.figures.cost.seconds < std::min(kQuicker * own.mean, own.mean - own.band))
        found.push_back(sweep.dial.title + " " + run.label +
                        number(" (%.2f of the time)", run.figures.cost.seconds / own.mean));
  return joined(found);
}

std::string neededTerms(const Trade& trade) {
  std::vector<std::string> found;
  for (const TradeSweep& sweep : trade.sweeps)
    for (const TradeRun& run : sweep.runs)
      if (sweep.dial.kind == DialKind::term && sweep.dial.name != kAllTogether && !trade.allWithin(run))
        found.push_back(sweep.dial.title + ": " + run.label + " (" + furthest(trade, run) + ")");
  return joined(found);
}

std::string idleTerms(const Trade& trade) {
  const std::vector<std::string> idle = termsWithoutEffect(trade);
  std::vector<std::string> titles;
  for (const TradeSweep& sweep : trade.sweeps)
    if (std::find(idle.begin(), idle.end(), sweep.dial.name) != idle.end())
      titles.push_back(sweep.dial.title + (sweep.runs.front().label == "on" ? " (off in the scene)" : ""));
  return joined(titles) + together(trade);
}

}  // namespace spume::apps
