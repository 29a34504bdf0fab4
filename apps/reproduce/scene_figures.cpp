#include "apps/reproduce/scene_figures.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numeric>

#include "coupling/atomic_file.h"
#include "coupling/csv_writer.h"
#include "coupling/run_folder.h"
#include "foam/power_diagram.h"

namespace spume::apps {
namespace {

constexpr char kPaper[] = "Busaryev 2012";

/// Worst |V - V0|/V0 of settled, unflagged bubbles of the last step, and how many were flagged.
struct VolumeCensus {
  double worst = 0;
  std::size_t flagged = 0;
};

VolumeCensus volumeCensus(const foam::BubbleStore& bubbles) {
  VolumeCensus census;
  for (std::size_t i = 0; i < bubbles.size(); ++i) {
    const bool flagged = bubbles.hidden[i] || bubbles.clamped[i];
    census.flagged += flagged;
    if (flagged || bubbles.age[i] < kSettledAge) continue;
    census.worst = std::max(census.worst, std::abs(bubbles.volume[i] / bubbles.gas[i] - 1));
  }
  return census;
}

/// Faces of the whole power diagram, most of which no ball reaches.
double diagramFaces(const foam::BubbleStore& bubbles) {
  if (bubbles.size() < 2) return 0;
  constexpr double kAll = std::numeric_limits<double>::infinity();
  return static_cast<double>(
      foam::alphaComplexEdges(bubbles.position, bubbles.radius, bubbles.id, kAll).size());
}

void addSizes(const SceneRun& run, const PaperFigures& paper, std::vector<ResultRow>& rows) {
  ResultRow bubbles = rowOf(run, "bubbles, most in a frame", paper.bubbles);
  ResultRow contacts = rowOf(run, "contacts (springs), most in a frame", paper.contacts);
  ResultRow faces = rowOf(run, "faces of the whole diagram, last frame", paper.faces);
  rows.push_back(reportOnly(bubbles, mostOf(run.frames.bubbles), ""));
  rows.push_back(reportOnly(contacts, mostOf(run.frames.contacts), ""));
  rows.push_back(reportOnly(faces, diagramFaces(run.bubbles()), ""));
}

void addTimes(const SceneRun& run, const PaperFigures& paper, std::vector<ResultRow>& rows) {
  ResultRow foam = rowOf(run, "time a full frame, without liquid and pictures", paper.foamSeconds);
  const double seconds = meanWhenFull(run, run.frames.foamSeconds);
  rows.push_back(paper.aimFoamSeconds ? aimAtMost(foam, seconds, *paper.aimFoamSeconds, "s")
                                      : reportOnly(foam, seconds, "s"));
  ResultRow quickest = rowOf(run, "the quickest of them");
  quickest.note = "nearest to a machine of one's own";
  rows.push_back(reportOnly(quickest, leastWhenFull(run, run.frames.foamSeconds), "s"));
  ResultRow diagram = rowOf(run, "of it the diagram", paper.foamSeconds.empty() ? "" : "3/4");
  rows.push_back(reportOnly(diagram, 100 * meanWhenFull(run, run.frames.diagramSeconds) / seconds, "%"));
  ResultRow whole = rowOf(run, "time a full frame, with the liquid");
  if (!run.scene.stillPool.enabled)
    rows.push_back(reportOnly(whole, meanWhenFull(run, run.frames.seconds), "s"));
  ResultRow steps = rowOf(run, "steps of the foam a frame, mean");
  const double frames = static_cast<double>(std::max<std::size_t>(run.frames.size(), 1));
  rows.push_back(reportOnly(steps, totalOf(run.frames.foamSteps) / frames, ""));
}

void addChecks(const SceneRun& run, const PaperFigures& paper, std::vector<ResultRow>& rows) {
  const VolumeCensus volumes = volumeCensus(run.bubbles());
  ResultRow worst = rowOf(run, "worst error of a bubble's volume, last frame", paper.volumeError);
  worst.note = "older than 1 s; " + std::to_string(volumes.flagged) + " of " +
               std::to_string(run.bubbles().size()) + " flagged and left out";
  rows.push_back(aimAtMost(worst, 100 * volumes.worst, 1, "%"));
  constexpr double kOff = 0.01;
  ResultRow everAbove = rowOf(run, "frames that end with a cell more than 1 % off, newborn ones counted");
  char most[64];
  std::snprintf(most, sizeof most, "the worst by %.3g %%", 100 * mostOf(run.frames.worstVolume));
  everAbove.note = most;
  rows.push_back(reportOnly(
      everAbove,
      static_cast<double>(std::count_if(run.frames.worstVolume.begin(), run.frames.worstVolume.end(),
                                        [](double error) { return error > kOff; })),
      ""));
  const BubbleBooks books = readBooks(coupling::RunFolder(run.folder).root() + "/events.csv");
  ResultRow lost = rowOf(run, "bubbles lost: born less ended less alive");
  lost.note = std::to_string(books.born) + " born, " + std::to_string(books.left) + " left the domain";
  const double missing = static_cast<double>(books.born) - static_cast<double>(books.ended) -
                         static_cast<double>(run.bubbles().size());
  rows.push_back(aimAtMost(lost, missing, 0, ""));
  ResultRow inside = rowOf(run, "bubbles inside solids, last frame");
  const Eigen::VectorXd toSolids = run.distanceToSolids(run.bubbles().position);
  char deepest[64];
  std::snprintf(deepest, sizeof deepest, "centre of the deepest %.2f radii in",
                deepestInSolids(run.bubbles(), toSolids));
  inside.note = deepest;
  rows.push_back(aimAtMost(inside, static_cast<double>(insideSolids(run.bubbles(), toSolids)), 0, ""));
}

}  // namespace

ResultRow rowOf(const SceneRun& run, const std::string& quantity) {
  ResultRow row;
  row.resolution = std::to_string(run.frames.size()) + " frames";
  if (!run.scene.stillPool.enabled)
    row.resolution += ", " + std::to_string(run.scene.domain.resolution) + " cells";
  row.quantity = quantity;
  return row;
}

ResultRow rowOf(const SceneRun& run, const std::string& quantity, const std::string& paper) {
  ResultRow row = rowOf(run, quantity);
  row.reference = paper;
  if (!paper.empty()) row.source = kPaper;
  return row;
}

double mostOf(const std::vector<double>& column) {
  return column.empty() ? 0 : *std::max_element(column.begin(), column.end());
}

double totalOf(const std::vector<double>& column) {
  return std::accumulate(column.begin(), column.end(), 0.0);
}

double meanOf(const std::vector<double>& column) {
  return column.empty() ? 0 : totalOf(column) / static_cast<double>(column.size());
}

std::size_t lateBegin(std::size_t size) {
  const auto late = static_cast<std::size_t>(kLatePart * static_cast<double>(size)) + 1;
  return size - std::min(late, size);
}

double lateMean(const std::vector<double>& column) {
  const std::size_t begin = lateBegin(column.size());
  double sum = 0;
  for (std::size_t n = begin; n < column.size(); ++n) sum += column[n];
  return sum / static_cast<double>(column.size() - begin);
}

double earlyMean(const std::vector<double>& column) {
  const std::size_t end = (column.size() + 2) / 3;
  double sum = 0;
  for (std::size_t n = 0; n < end; ++n) sum += column[n];
  return sum / static_cast<double>(end);
}

double meanWhenFull(const SceneRun& run, const std::vector<double>& column) {
  const double full = kFullShare * mostOf(run.frames.bubbles);
  double sum = 0, frames = 0;
  for (std::size_t f = 0; f < column.size(); ++f)
    if (run.frames.bubbles[f] >= full) sum += column[f], ++frames;
  return sum / frames;
}

double leastWhenFull(const SceneRun& run, const std::vector<double>& column) {
  const double full = kFullShare * mostOf(run.frames.bubbles);
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t f = 0; f < column.size(); ++f)
    if (run.frames.bubbles[f] >= full) least = std::min(least, column[f]);
  return least;
}

double worstDrift(const FrameCurves& frames) {
  double worst = 0;
  for (std::size_t f = 0; f < frames.size(); ++f)
    if (frames.targetVolume[f] > 0)
      worst = std::max(worst, std::abs(frames.liquidVolume[f] / frames.targetVolume[f] - 1));
  return worst;
}

std::vector<ResultRow> commonFigures(const SceneRun& run, const PaperFigures& paper) {
  std::vector<ResultRow> rows;
  addSizes(run, paper, rows);
  addTimes(run, paper, rows);
  addChecks(run, paper, rows);
  return rows;
}

void writePlot(const std::string& folder, const std::string& name, const std::string& svg) {
  coupling::createFolder(folder);
  coupling::replaceFile(folder + "/" + name + ".svg", svg);
}

void writeCurves(const std::string& folder, const std::string& name, const FrameCurves& curves) {
  coupling::createFolder(folder);
  const std::vector<const std::vector<double>*> columns{
      &curves.frame,       &curves.time,           &curves.steps,       &curves.foamSteps,   &curves.bubbles,
      &curves.surface,     &curves.contacts,       &curves.overlaps,    &curves.flagged,     &curves.seconds,
      &curves.foamSeconds, &curves.diagramSeconds, &curves.worstVolume, &curves.medianVolume};
  coupling::writeCsv(folder + "/" + name + ".csv",
                     "frame,time,steps,foam_steps,bubbles,bubbles_surface,contacts,overlaps,flagged,seconds,"
                     "seconds_foam,seconds_diagram,volume_error_max,volume_error_median",
                     curves.size(), [&](std::size_t row, coupling::CsvRow& out) {
                       for (const auto* column : columns) out.number((*column)[row]);
                     });
}

}  // namespace spume::apps
