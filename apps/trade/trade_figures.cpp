#include "apps/trade/trade_figures.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "apps/reproduce/foam_metrics.h"
#include "apps/reproduce/scene_figures.h"

namespace spume::apps {
namespace {

constexpr double kPercent = 100, kMillimetre = 1e3, kMillilitre = 1e6;
constexpr double kHeadShare = 0.95;  ///< of the gas, from below: single bubbles thrown up are no head

/// Where the gas of a cached frame lies.
struct GasHeights {
  double mean = 0, head = 0;  ///< [m]
};

GasHeights heightsOf(const foam::BubbleStore& bubbles) {
  std::vector<std::pair<double, double>> gasAt;  // height, gas
  double gas = 0, moment = 0;
  for (std::size_t i = 0; i < bubbles.size(); ++i) {
    gasAt.emplace_back(bubbles.position[i].y(), bubbles.gas[i]);
    gas += bubbles.gas[i], moment += bubbles.gas[i] * bubbles.position[i].y();
  }
  if (gas == 0) return {};
  std::sort(gasAt.begin(), gasAt.end());
  double below = 0;
  const auto head = std::find_if(gasAt.begin(), gasAt.end(),
                                 [&](const auto& one) { return (below += one.second) >= kHeadShare * gas; });
  return {moment / gas, head == gasAt.end() ? gasAt.back().first : head->first};
}

/// Columns over the cached frames that hold bubbles.
struct CachedColumns {
  std::vector<double> mean, head, clustered;  ///< [mm], [mm], [%]
};

/// The cached frames of the late part. Throws SceneError if there is none: no figure is 0 for lack of data.
std::vector<CachedFrame> lateCachedFrames(const SceneRun& run) {
  std::vector<CachedFrame> cached =
      cachedFrames(run, static_cast<int>(lateBegin(run.frames.size())) + 1);  // frames count from 1
  if (cached.empty())
    throw coupling::SceneError(run.folder + ": none of its last frames is cached, which figures are taken " +
                               "from (output.every = " + std::to_string(run.scene.output.every) +
                               "); run it longer, or anew with --set output.every=1 --restart");
  return cached;
}

CachedColumns cachedColumns(const SceneRun& run) {
  CachedColumns columns;
  for (const CachedFrame& cached : lateCachedFrames(run)) {
    if (cached.bubbles.size() == 0) continue;
    const GasHeights heights = heightsOf(cached.bubbles);
    const SurfaceCensus census = surfaceCensus(cached.bubbles, run.distanceToSolids(cached.bubbles.position));
    columns.mean.push_back(kMillimetre * heights.mean);
    columns.head.push_back(kMillimetre * heights.head);
    columns.clustered.push_back(kPercent * census.clustered);
  }
  return columns;
}

/// Largest of the late part of a column.
double lateMost(const std::vector<double>& column) {
  return mostOf({column.begin() + static_cast<std::ptrdiff_t>(lateBegin(column.size())), column.end()});
}

}  // namespace

TradeFigures tradeFiguresOf(const SceneRun& run) {
  const FrameCurves& frames = run.frames;
  const CachedColumns cached = cachedColumns(run);
  TradeFigures figures;
  figures.values = {lateMean(frames.bubbles),
                    totalOf(frames.births),
                    lateMean(frames.contacts),
                    meanOf(cached.mean),
                    meanOf(cached.head),
                    meanOf(cached.clustered),
                    kMillilitre * lateMean(frames.gas),
                    kPercent * worstDrift(frames),
                    kPercent * lateMost(frames.worstVolume)};
  figures.cost = {meanOf(frames.seconds), meanOf(frames.liquidSeconds), meanOf(frames.foamSeconds),
                  meanOf(frames.pressureIterations), meanOf(frames.foamIterations)};
  return figures;
}

}  // namespace spume::apps
