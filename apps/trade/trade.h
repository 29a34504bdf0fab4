#pragma once

#include <functional>
#include <string>
#include <vector>

#include "apps/reproduce/reproduction.h"
#include "apps/trade/trade_dials.h"
#include "apps/trade/trade_figures.h"

namespace spume::apps {

/// One run of a scene with something changed.
struct TradeRun {
  std::string label;
  TradeFigures figures;
  /// Why it did not get to its end, "diverged: ..." or "refused: ..."; then the figures mean nothing.
  std::string failure = {};

  std::string failureWord() const { return failure.substr(0, failure.find(':')); }
};

/// A dial or term and its runs; settings that are the scene's own are left out.
struct TradeSweep {
  Dial dial;
  std::vector<TradeRun> runs;
};

/// What other seeds make of a figure.
struct Noise {
  double mean = 0;
  /// Half-width of the band about the mean in which a further run lies 99 times of 100, if runs scatter
  /// normally: t sqrt(1 + 1/n) s of n seeds [the figure's unit].
  double band = 0;
};
Noise noiseOf(const std::vector<double>& ofSeeds);

/// Seeds the band is known for.
inline constexpr int kFewestSeeds = 2, kMostSeeds = 10;

/// Speed against accuracy of a scene.
struct Trade {
  coupling::Scene scene;
  std::vector<TradeRun> own;  ///< the scene's settings, one run a seed
  TradeRun reference;         ///< every dial at its finest
  std::vector<TradeSweep> sweeps;

  /// The scene's own settings as if they were one run: means over the seeds.
  TradeRun mean() const;
  Noise noise(std::size_t figure) const;
  Noise seconds() const;  ///< a frame: times, too, have their noise
  /// Difference that counts as none: the noise's band, or what nobody would see.
  double tolerance(std::size_t figure) const;
  /// A difference in such widths; 0 of none, also where the width is 0 [-].
  double inTolerances(double difference, std::size_t figure) const;
  /// Whether a run's figure may be that of the scene with another seed.
  bool within(const TradeRun& run, std::size_t figure) const;
  bool allWithin(const TradeRun& run) const;
};

/// What to run.
struct TradePlan {
  /// The scene with overrides put in.
  std::function<coupling::Scene(const coupling::Overrides&)> read;
  std::vector<std::string> dials;  ///< names; empty: all
  int seeds = 5;
};

/// Runs the scene with several seeds, the reference, and every dial and term by itself; then, where several
/// terms changed nothing beyond the noise, without all of these at once. A run that diverges is noted, but
/// for those of the scene itself and the reference: throws std::runtime_error, what else the runs throw, and
/// SceneError; that of a reference the scene does not allow before anything runs.
Trade runTrade(const TradePlan& plan, const StudyContext& context);

/// Names of the terms that change no figure beyond the noise when they are switched.
std::vector<std::string> termsWithoutEffect(const Trade& trade);

/// What switches all of them at once. Where two set the same key, the first has it, as it is the wider one:
/// without drag it does not matter whose law it followed.
coupling::Overrides allWithoutEffect(const Trade& trade);

/// Name of the sweep in which all of them are switched at once.
inline constexpr char kAllTogether[] = "together";

}  // namespace spume::apps
