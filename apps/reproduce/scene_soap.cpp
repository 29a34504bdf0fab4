#include <algorithm>

#include "apps/reproduce/plateau_angles.h"
#include "apps/reproduce/scene_figures.h"
#include "apps/reproduce/scene_studies.h"
#include "apps/reproduce/svg_plot.h"
#include "coupling/domain_box.h"
#include "foam/soap_films.h"

namespace spume::apps {
namespace {

/// Lines of a square lattice through the box, walls left out.
constexpr int kLinesAcross = 9;

/// Bubbles whose wetness has come down this far from that at the water to that aloft count as dry.
constexpr double kDryShare = 0.75;

/// Rms spread of plane films of a random power diagram; what is asked for is well under half [degrees].
constexpr double kRandomFilms = 24, kRandomBorders = 36, kWellUnderHalf = 0.45;

/// Speed of the pile's centroid that no froth rises with: a jump [m/s].
constexpr double kJump = 0.1;

std::vector<double> layerCounts(const SceneRun& run) {
  const coupling::DomainBox domain(run.scene);
  const Eigen::Vector3d &lower = domain.lower, size = domain.size();
  std::vector<double> layers;
  for (int i = 1; i <= kLinesAcross; ++i)
    for (int k = 1; k <= kLinesAcross; ++k)
      layers.push_back(layersAlong(run.bubbles(), run.topology, lower.x() + size.x() * i / (kLinesAcross + 1),
                                   lower.z() + size.z() * k / (kLinesAcross + 1)));
  return layers;
}

/// Flags the bubbles out of the water whose films are dry and whose volume is held.
std::vector<std::uint8_t> dryOnes(const SceneRun& run) {
  const foam::FoamParams& foam = run.scene.foam;
  const double limit = foam.wetness + kDryShare * (foam.wetnessAloft - foam.wetness);
  std::vector<std::uint8_t> dry(run.bubbles().size());
  for (std::size_t i = 0; i < dry.size(); ++i)
    dry[i] = run.bubbles().type[i] == foam::BubbleClass::air && run.bubbles().wetness[i] <= limit &&
             !run.bubbles().hidden[i] && !run.bubbles().clamped[i];
  return dry;
}

/// Largest change of the height of the pile's centroid between cached frames, as a speed [m/s].
double fastestRise(const SceneRun& run) {
  double fastest = 0, before = 0;
  int frameBefore = 0;
  for (const CachedFrame& cached : cachedFrames(run, 1)) {
    double gas = 0, height = 0;
    for (std::size_t i = 0; i < cached.bubbles.size(); ++i)
      if (cached.bubbles.type[i] != foam::BubbleClass::liquid)
        gas += cached.bubbles.gas[i], height += cached.bubbles.gas[i] * cached.bubbles.position[i].y();
    if (gas == 0) continue;
    height /= gas;
    const double seconds = (cached.frame - frameBefore) / run.scene.time.fps;
    if (frameBefore > 0) fastest = std::max(fastest, std::abs(height - before) / seconds);
    before = height, frameBefore = cached.frame;
  }
  return fastest;
}

/// Of the films as they are drawn and exported, then of the plane ones the bubbles move by.
void addAngles(const SceneRun& run, std::vector<ResultRow>& rows) {
  const std::vector<std::uint8_t> dry = dryOnes(run);
  const foam::SoapFilms soap = foam::soapFilms(run.bubbles(), *run.liquid->sampler());
  const PlateauAngles curved = plateauAngles(soap.network, dry);
  ResultRow films = rowOf(run, "spread of the films' angles about 120 deg, dry part, films drawn");
  films.reference = "random power diagram 24 deg";
  films.note =
      std::to_string(curved.films.size() / 3) + " stretches of borders; soap films (foam/soap_films)";
  rows.push_back(aimAtMost(films, curved.filmSpread(), kWellUnderHalf * kRandomFilms, "deg"));
  ResultRow borders = rowOf(run, "spread of the borders' angles about 109.47 deg, dry part, films drawn");
  borders.reference = "random power diagram 36 deg";
  borders.note = std::to_string(curved.borders.size() / 6) + " points";
  rows.push_back(aimAtMost(borders, curved.borderSpread(), kWellUnderHalf * kRandomBorders, "deg"));
  ResultRow held = rowOf(run, "largest change of a cell's volume by the films' shape");
  rows.push_back(aimAtMost(held, 100 * soap.report.worstVolume, 1, "%"));

  const PlateauAngles plane = plateauAngles(run.bubbles().position, run.bubbles().radius, run.topology, dry);
  ResultRow planeFilms = rowOf(run, "films' angles, plane films of the model's cells");
  rows.push_back(reportOnly(planeFilms, plane.filmSpread(), "deg"));
  ResultRow planeBorders = rowOf(run, "borders' angles, plane films of the model's cells");
  rows.push_back(reportOnly(planeBorders, plane.borderSpread(), "deg"));
  const PlateauAngles rest = anglesAtRest(run.bubbles().radius, plane);
  ResultRow restFilms = rowOf(run, "films' angles of the same bubbles, every pair at Plateau's distance");
  restFilms.note = "plane films of unequal bubbles spread so much at rest";
  rows.push_back(reportOnly(restFilms, rest.filmSpread(), "deg"));
  ResultRow restBorders = rowOf(run, "borders' angles of the same bubbles, every pair at Plateau's distance");
  restBorders.note = std::to_string(rest.pointsCells.size()) + " points";
  rows.push_back(reportOnly(restBorders, rest.borderSpread(), "deg"));
}

/// Fig. 8: bubbles blown into soapy water pile up.
std::vector<ResultRow> soap(const StudyContext& context) {
  const SceneRun run = runScene(context, "soap", "soap");
  const FrameCurves& f = run.frames;
  writePlot(context.folder, "soap_growth",
            svgOf({{"Size of the froth",
                    "frame",
                    "number",
                    {{"bubbles", f.frame, f.bubbles}, {"contacts", f.frame, f.contacts}}},
                   {"Time of a frame",
                    "frame",
                    "time [s]",
                    {{"whole", f.frame, f.foamSeconds}, {"diagram", f.frame, f.diagramSeconds}}}}));
  writeCurves(context.folder, "soap", f);

  std::vector<ResultRow> rows =
      commonFigures(run, {.bubbles = "4K", .foamSeconds = "0.6-2.0 s", .aimFoamSeconds = 0.2});
  const std::vector<double> layers = layerCounts(run);
  ResultRow median = rowOf(run, "layers along 81 vertical lines, median", ">= 10");
  median.note = "most " + std::to_string(static_cast<int>(mostOf(layers)));
  rows.push_back(aimAtLeast(median, medianOf(layers), 10, ""));
  ResultRow jump = rowOf(run, "fastest move of the pile's centroid");
  rows.push_back(aimAtMost(jump, fastestRise(run), kJump, "m/s"));
  addAngles(run, rows);
  return rows;
}

}  // namespace

Study soapStudy() { return {"soap", "froth in a glass box", 240, soap}; }

}  // namespace spume::apps
