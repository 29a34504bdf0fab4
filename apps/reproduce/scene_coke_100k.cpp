#include "apps/reproduce/scene_figures.h"
#include "apps/reproduce/scene_studies.h"
#include "apps/reproduce/svg_plot.h"

namespace spume::apps {
namespace {

/// Fig. 7: how cost and complexity grow with the scene.
std::vector<ResultRow> crowdedCoke(const StudyContext& context) {
  const SceneRun run = runScene(context, "coke_100k", "coke_100k");
  const FrameCurves& f = run.frames;
  writePlot(context.folder, "coke_100k_frames",
            svgOf({{"Time of a frame, without the liquid",
                    "frame",
                    "time [s]",
                    {{"animation", f.frame, f.foamSeconds}, {"diagram", f.frame, f.diagramSeconds}}},
                   {"Complexity",
                    "frame",
                    "number",
                    {{"contacts (springs)", f.frame, f.contacts},
                     {"faces within reach of both balls", f.frame, f.overlaps},
                     {"bubbles", f.frame, f.bubbles}}}}));
  writeCurves(context.folder, "coke_100k", f);
  return commonFigures(run, {.bubbles = "100K",
                             .contacts = "> 500K",
                             .faces = "> 1M",
                             .foamSeconds = "13-17 s",
                             .aimFoamSeconds = 1.0});
}

}  // namespace

Study crowdedCokeStudy() { return {"coke_100k", "100000 bubbles in a mug", 3600, crowdedCoke}; }

}  // namespace spume::apps
