#include <algorithm>

#include "apps/reproduce/scene_figures.h"
#include "apps/reproduce/scene_studies.h"
#include "apps/reproduce/svg_plot.h"

namespace spume::apps {
namespace {

/// Worst error over the frames of the last second [-].
double lastSecond(const SceneRun& run) {
  const std::vector<double>& worst = run.frames.worstVolume;
  const auto count = std::min(worst.size(), static_cast<std::size_t>(run.scene.time.fps));
  return *std::max_element(worst.end() - static_cast<std::ptrdiff_t>(count), worst.end());
}

Curve errorCurve(const std::string& name, const SceneRun& run) {
  Curve curve{name, run.frames.frame, run.frames.worstVolume};
  for (double& error : curve.y) error *= 100;
  return curve;
}

/// Fig. 6: the same cluster with and without correction of the volumes.
std::vector<ResultRow> cluster(const StudyContext& context) {
  const SceneRun held = runScene(context, "cluster", "cluster");
  const SceneRun loose = runScene(context, "cluster", "cluster_uncorrected", {{"foam.volume_rate", "0"}});
  const std::vector<Curve> curves{errorCurve("with correction", held), errorCurve("without", loose)};
  writePlot(context.folder, "cluster_volume",
            svgOf({{"Worst error of a bubble's volume", "frame", "error [%]", curves},
                   {"The same, logarithmic", "frame", "error [%]", curves, true}}));
  writeCurves(context.folder, "cluster", held.frames);
  writeCurves(context.folder, "cluster_uncorrected", loose.frames);

  std::vector<ResultRow> rows = commonFigures(held, {.volumeError = "25 %"});
  ResultRow rest = rowOf(held, "worst error of a bubble's volume in the last second", "25 %");
  rows.push_back(aimAtMost(rest, 100 * lastSecond(held), 1, "%"));
  ResultRow without = rowOf(loose, "the same without correction", "75 %");
  rows.push_back(reportOnly(without, 100 * lastSecond(loose), "%"));
  ResultRow peak = rowOf(held, "worst error of any frame", "25 %");
  peak.note = "bubbles are blown in among others";
  rows.push_back(reportOnly(peak, 100 * mostOf(held.frames.worstVolume), "%"));
  return rows;
}

}  // namespace

Study clusterStudy() { return {"cluster", "equal bubbles between two plates", 30, cluster}; }

}  // namespace spume::apps
