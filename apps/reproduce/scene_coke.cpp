#include "apps/reproduce/scene_figures.h"
#include "apps/reproduce/scene_studies.h"
#include "apps/reproduce/svg_plot.h"

namespace spume::apps {
namespace {

/// How the floating bubbles of a run lie, cached frame by cached frame.
struct CensusCurves {
  std::vector<double> frame, clustered, atWalls, clinging;  ///< [-], [%]
};

CensusCurves censusOf(const SceneRun& run) {
  CensusCurves curves;
  for (const CachedFrame& cached : cachedFrames(run, 1)) {
    if (cached.bubbles.size() == 0) continue;
    const SurfaceCensus now = surfaceCensus(cached.bubbles, run.distanceToSolids(cached.bubbles.position));
    curves.frame.push_back(cached.frame);
    curves.clustered.push_back(100 * now.clustered);
    curves.atWalls.push_back(100 * now.atWalls);
    curves.clinging.push_back(100 * now.clinging);
  }
  return curves;
}

void addShares(const SceneRun& run, const CensusCurves& curves, std::vector<ResultRow>& rows) {
  ResultRow clustered = rowOf(run, "floating bubbles in contact with another, last third"),
            walls = rowOf(run, "floating bubbles at a wall, last third"),
            clinging = rowOf(run, "submerged bubbles at the glass, last third");
  rows.push_back(reportOnly(clustered, lateMean(curves.clustered), "%"));
  rows.push_back(reportOnly(walls, lateMean(curves.atWalls), "%"));
  rows.push_back(reportOnly(clinging, lateMean(curves.clinging), "%"));
}

/// The paper shows pictures only: the difference must be of the right sign.
ResultRow differenceRow(const SceneRun& run, const std::string& what, double with, double without) {
  ResultRow row = rowOf(run, what + ": coke less plastic");
  row.reference = "more, Fig. 10";
  row.source = "Busaryev 2012";
  return aimAtLeast(row, with - without, 0, "%");
}

Plot comparison(const std::string& title, const CensusCurves& coke, const std::vector<double>& with,
                const CensusCurves& plastic, const std::vector<double>& without) {
  return {title,
          "frame",
          "share [%]",
          {{"coke", coke.frame, with}, {"plastic: strong forces only", plastic.frame, without}}};
}

/// Fig. 10: attraction on and off.
std::vector<ResultRow> coke(const StudyContext& context) {
  const SceneRun run = runScene(context, "coke", "coke"),
                 beads = runScene(context, "coke_plastic", "coke_plastic");
  const CensusCurves a = censusOf(run), b = censusOf(beads);
  writePlot(context.folder, "coke_clusters",
            svgOf({comparison("Floating bubbles in contact with another", a, a.clustered, b, b.clustered),
                   comparison("Floating bubbles at a wall", a, a.atWalls, b, b.atWalls),
                   comparison("Submerged bubbles at the glass", a, a.clinging, b, b.clinging)}));
  writeCurves(context.folder, "coke", run.frames);
  writeCurves(context.folder, "coke_plastic", beads.frames);

  std::vector<ResultRow> rows =
      commonFigures(run, {.bubbles = "16K", .foamSeconds = "0.5-2.8 s", .aimFoamSeconds = 0.15});
  std::vector<ResultRow> plain = commonFigures(beads, {});
  addShares(run, a, rows);
  addShares(beads, b, plain);
  for (ResultRow& row : plain) row.title = "the same of plastic";
  rows.insert(rows.end(), plain.begin(), plain.end());
  ResultRow contact = differenceRow(run, "floating bubbles in contact with another, first third",
                                    earlyMean(a.clustered), earlyMean(b.clustered));
  contact.note = "while the heads form; once they are full all bubbles touch, attracted or not";
  rows.push_back(contact);
  rows.push_back(
      differenceRow(run, "floating bubbles at a wall, last third", lateMean(a.atWalls), lateMean(b.atWalls)));
  return rows;
}

}  // namespace

Study cokeStudy() { return {"coke", "cola poured into a mug, and the same of plastic", 1800, coke}; }

}  // namespace spume::apps
