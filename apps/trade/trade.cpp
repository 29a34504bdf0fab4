#include "apps/trade/trade.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "fluid/errors.h"
#include "foam/errors.h"

namespace spume::apps {
namespace {

/// Student's t for 1 to 9 degrees of freedom, two-sided 99 %.
constexpr double kStudent[] = {63.657, 9.925, 5.841, 4.604, 4.032, 3.707, 3.499, 3.355, 3.250};
static_assert(std::size(kStudent) == kMostSeeds - 1);

/// "step=0.04", "volumes=newton_to_5e-2".
std::string folderNameOf(const Dial& dial, const DialSetting& setting) {
  std::string name = dial.name + "=" + setting.label;
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
}

/// Runs variants of one scene.
class Runner {
 public:
  Runner(const TradePlan& plan, const StudyContext& context)
      : plan_(plan), context_(context), own_(plan.read({})), ownText_(coupling::writeScene(own_)) {}

  const coupling::Scene& own() const { return own_; }

  TradeRun run(const std::string& label, const std::string& folder, const coupling::Scene& scene) const {
    TradeRun result{label, {}};
    try {
      result.figures = tradeFiguresOf(runScene(context_, scene, folder));
    } catch (const fluid::NumericalFailure& failure) {
      result.failure = std::string("diverged: ") + failure.what();
    } catch (const foam::NumericalFailure& failure) {
      result.failure = std::string("diverged: ") + failure.what();
    }
    return result;
  }

  /// The same with a setting that the scene may not allow: a nozzle, say, too thin for coarser cells.
  TradeRun run(const Dial& dial, const DialSetting& setting) const {
    coupling::Scene scene;
    try {
      scene = plan_.read(setting.overrides);
    } catch (const coupling::SceneError& refusal) {
      return {setting.label, {}, std::string("refused: ") + refusal.what()};
    }
    return run(setting.label, folderNameOf(dial, setting), scene);
  }

  /// Whether the overrides say what the scene says.
  bool changesNothing(const coupling::Overrides& overrides) const {
    try {
      return coupling::writeScene(plan_.read(overrides)) == ownText_;
    } catch (const coupling::SceneError&) {
      return false;
    }
  }

  /// A run for each setting that is not the scene's own.
  TradeSweep sweep(const Dial& dial) const {
    TradeSweep sweep{dial, {}};
    for (const DialSetting& setting : dial.settings)
      if (!changesNothing(setting.overrides)) sweep.runs.push_back(run(dial, setting));
    return sweep;
  }

 private:
  const TradePlan& plan_;
  const StudyContext& context_;
  coupling::Scene own_;
  std::string ownText_;
};

void requireFinished(const TradeRun& run) {
  if (!run.failure.empty()) throw std::runtime_error(run.label + ": " + run.failure);
}

/// What may go may not go together: a last run finds out.
void addTogether(const Runner& runner, Trade& trade) {
  if (termsWithoutEffect(trade).size() < 2) return;
  const DialSetting off{"off", allWithoutEffect(trade)};
  trade.sweeps.push_back(
      runner.sweep({kAllTogether, "the terms without effect, all at once", DialKind::term, {off}}));
}

}  // namespace

Noise noiseOf(const std::vector<double>& ofSeeds) {
  const double n = static_cast<double>(ofSeeds.size());
  Noise noise;
  for (const double value : ofSeeds) noise.mean += value / n;
  if (ofSeeds.size() < 2) return noise;
  double squares = 0;
  for (const double value : ofSeeds) squares += std::pow(value - noise.mean, 2);
  noise.band = kStudent[ofSeeds.size() - 2] * std::sqrt((1 + 1 / n) * squares / (n - 1));
  return noise;
}

TradeRun Trade::mean() const {
  TradeRun mean{"own", {}};
  for (std::size_t k = 0; k < kTradeFigures.size(); ++k) mean.figures.values[k] = noise(k).mean;
  TradeCost& cost = mean.figures.cost;
  const double n = static_cast<double>(own.size());
  for (const TradeRun& run : own)
    for (const auto part : {&TradeCost::seconds, &TradeCost::liquidSeconds, &TradeCost::foamSeconds,
                            &TradeCost::pressureIterations, &TradeCost::foamIterations})
      cost.*part += run.figures.cost.*part / n;
  return mean;
}

Noise Trade::noise(std::size_t figure) const {
  std::vector<double> values;
  for (const TradeRun& run : own) values.push_back(run.figures.values[figure]);
  return noiseOf(values);
}

Noise Trade::seconds() const {
  std::vector<double> values;
  for (const TradeRun& run : own) values.push_back(run.figures.cost.seconds);
  return noiseOf(values);
}

double Trade::tolerance(std::size_t figure) const {
  const Noise scatter = noise(figure);
  const TradeFigure& kind = kTradeFigures[figure];
  return std::max({scatter.band, kind.share * std::abs(scatter.mean), kind.amount});
}

double Trade::inTolerances(double difference, std::size_t figure) const {
  return difference == 0 ? 0 : difference / tolerance(figure);
}

bool Trade::within(const TradeRun& run, std::size_t figure) const {
  return std::abs(run.figures.values[figure] - noise(figure).mean) <= tolerance(figure);
}

bool Trade::allWithin(const TradeRun& run) const {
  for (std::size_t figure = 0; figure < kTradeFigures.size(); ++figure)
    if (!within(run, figure)) return false;
  return run.failure.empty();
}

Trade runTrade(const TradePlan& plan, const StudyContext& context) {
  const Runner runner(plan, context);
  Trade trade{runner.own(), {}, {}, {}};
  const std::vector<Dial> all = dialsOf(trade.scene), chosen = selectDials(all, plan.dials);
  const coupling::Scene finest = plan.read(finestOf(all));  // what it refuses, it does before anything runs
  for (int n = 0; n < plan.seeds; ++n) {
    const std::string seed = std::to_string(trade.scene.seed + static_cast<std::uint64_t>(n));
    trade.own.push_back(runner.run("seed " + seed, "seed=" + seed, plan.read({{"scene.seed", seed}})));
    requireFinished(trade.own.back());
  }
  trade.reference = runner.run("reference", "reference", finest);
  requireFinished(trade.reference);
  for (const Dial& dial : chosen) trade.sweeps.push_back(runner.sweep(dial));
  addTogether(runner, trade);
  return trade;
}

std::vector<std::string> termsWithoutEffect(const Trade& trade) {
  std::vector<std::string> names;
  for (const TradeSweep& sweep : trade.sweeps) {
    const bool isTerm = sweep.dial.kind == DialKind::term && sweep.dial.name != kAllTogether;
    if (!isTerm || sweep.runs.empty()) continue;
    if (std::all_of(sweep.runs.begin(), sweep.runs.end(),
                    [&](const TradeRun& run) { return trade.allWithin(run); }))
      names.push_back(sweep.dial.name);
  }
  return names;
}

coupling::Overrides allWithoutEffect(const Trade& trade) {
  const std::vector<std::string> idle = termsWithoutEffect(trade);
  coupling::Overrides all;
  for (const TradeSweep& sweep : trade.sweeps) {
    if (std::find(idle.begin(), idle.end(), sweep.dial.name) == idle.end()) continue;
    for (const coupling::Override& one : sweep.dial.settings.front().overrides)
      if (std::none_of(all.begin(), all.end(), [&](const auto& other) { return other.key == one.key; }))
        all.push_back(one);
  }
  return all;
}

}  // namespace spume::apps
