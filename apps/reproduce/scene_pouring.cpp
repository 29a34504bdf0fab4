#include <algorithm>

#include "apps/reproduce/scene_figures.h"
#include "apps/reproduce/scene_studies.h"
#include "apps/reproduce/svg_plot.h"

namespace spume::apps {
namespace {

/// Short-lived: the longest median the eye takes for bursting on arrival [s].
constexpr double kShortLife = 1;

/// Share of the values at most as large as each of them.
Curve sharesOf(const std::string& name, std::vector<double> values) {
  std::sort(values.begin(), values.end());
  Curve curve{name, values, {}};
  for (std::size_t n = 0; n < values.size(); ++n)
    curve.y.push_back(100 * static_cast<double>(n + 1) / static_cast<double>(values.size()));
  return curve;
}

/// Fig. 9: every bubble is born from the liquid's markers.
std::vector<ResultRow> pouring(const StudyContext& context) {
  const SceneRun run = runScene(context, "pouring", "pouring");
  const BubbleBooks books = readBooks(run.folder + "/events.csv");
  writePlot(context.folder, "pouring_lives",
            svgOf({{"Bubbles that burst by age",
                    "time out of the water [s]",
                    "burst [%]",
                    {sharesOf("all bursts", books.surfaceLives)}},
                   {"Bubbles",
                    "frame",
                    "number",
                    {{"alive", run.frames.frame, run.frames.bubbles},
                     {"at the surface", run.frames.frame, run.frames.surface}}}}));
  writeCurves(context.folder, "pouring", run.frames);

  std::vector<ResultRow> rows = commonFigures(run, {.bubbles = "3.4K"});
  ResultRow life = rowOf(run, "median life out of the water of bubbles that burst");
  life.note = "the scene asks for 0.4 s at r 1 mm; " + std::to_string(books.surfaceLives.size()) + " bursts";
  rows.push_back(aimAtMost(life, medianOf(books.surfaceLives), kShortLife, "s"));
  return rows;
}

}  // namespace

Study pouringStudy() { return {"pouring", "jet into a glass box", 300, pouring}; }

}  // namespace spume::apps
