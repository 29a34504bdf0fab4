#include "apps/reproduce/scene_run.h"

#include <filesystem>

#include "apps/reproduce/csv_reader.h"
#include "coupling/bubble_cache.h"
#include "coupling/checkpoint.h"
#include "coupling/run_folder.h"
#include "foam/power_cells.h"

namespace spume::apps {
namespace {

/// A column of numbers and the list it fills.
struct Wanted {
  const char* name;
  std::vector<double>& values;
};

std::size_t append(CsvReader& reader, const std::vector<Wanted>& wanted) {
  std::vector<std::size_t> columns;
  for (const Wanted& w : wanted) columns.push_back(reader.column(w.name));
  std::size_t rows = 0;
  for (; reader.next(); ++rows)
    for (std::size_t n = 0; n < wanted.size(); ++n) wanted[n].values.push_back(reader.number(columns[n]));
  return rows;
}

/// Adds up, or takes the last of, the steps of each frame.
void foldSteps(const std::string& folder, FrameCurves& curves) {
  std::vector<double> time, foamSteps, hidden, clamped, overlaps, entrain, supply, foam, geometry;
  CsvReader reader(folder + "/steps.csv");
  append(reader, {{"time", time},
                  {"foam_substeps", foamSteps},
                  {"hidden", hidden},
                  {"clamped", clamped},
                  {"overlaps", overlaps},
                  {"seconds_entrainment", entrain},
                  {"seconds_supply", supply},
                  {"seconds_foam", foam},
                  {"seconds_foam_geometry", geometry}});
  std::size_t step = 0;
  constexpr double kRoundOff = 1e-9;  // relative: the last step of a frame may miss its end by so much
  for (const double end : curves.time) {
    double split = 0, seconds = 0, diagram = 0;
    for (; step < time.size() && time[step] <= end * (1 + kRoundOff); ++step) {
      split += foamSteps[step];
      seconds += entrain[step] + supply[step] + foam[step];
      diagram += geometry[step];
    }
    curves.foamSteps.push_back(split);
    curves.foamSeconds.push_back(seconds);
    curves.diagramSeconds.push_back(diagram);
    curves.overlaps.push_back(step ? overlaps[step - 1] : 0);
    curves.flagged.push_back(step ? hidden[step - 1] + clamped[step - 1] : 0);
  }
}

/// The figures need the PLY of bubbles alone, and that whatever the scene says.
coupling::Scene withBubblesAlone(coupling::Scene scene) {
  coupling::OutputSpec& output = scene.output;
  output.preview = output.liquid = output.bubblesVdb = output.dropsVdb = output.dropsPly = output.films =
      false;
  output.bubblesPly = true;
  return scene;
}

/// A folder that was run further than asked has the checkpoint of a later frame: no shorter run is in it.
void requireAskedLength(const SceneRun& run) {
  const int asked = run.scene.time.frames;
  if (run.frames.size() <= static_cast<std::size_t>(asked)) return;
  const std::string held = std::to_string(run.frames.size());
  throw coupling::SceneError(run.folder + ": holds a run of " + held + " frames, longer than the " +
                             std::to_string(asked) + " asked for; ask for --frames " + held +
                             ", name another folder with --runs, or start anew with --restart");
}

}  // namespace

FrameCurves readFrameCurves(const std::string& folder) {
  FrameCurves curves;
  CsvReader reader(folder + "/frames.csv");
  append(reader, {{"frame", curves.frame},
                  {"time", curves.time},
                  {"steps", curves.steps},
                  {"bubbles", curves.bubbles},
                  {"bubbles_surface", curves.surface},
                  {"contacts", curves.contacts},
                  {"births", curves.births},
                  {"seconds", curves.seconds},
                  {"seconds_liquid", curves.liquidSeconds},
                  {"liquid_volume", curves.liquidVolume},
                  {"target_volume", curves.targetVolume},
                  {"pressure_iterations", curves.pressureIterations},
                  {"foam_iterations", curves.foamIterations},
                  {"gas_in_bubbles", curves.gas},
                  {"volume_error_max", curves.worstVolume},
                  {"volume_error_median", curves.medianVolume}});
  foldSteps(folder, curves);
  return curves;
}

Eigen::VectorXd SceneRun::distanceToSolids(const std::vector<Eigen::Vector3d>& points) const {
  Eigen::VectorXd psi(static_cast<Eigen::Index>(points.size()));
  if (points.empty()) return psi;
  const Eigen::Map<const Eigen::Matrix3Xd> x(points.front().data(), 3, psi.size());
  liquid->sampler()->psi(x, psi);
  return psi;
}

SceneRun runScene(const StudyContext& context, const std::string& name, const std::string& variant,
                  const coupling::Overrides& overrides) {
  coupling::Scene scene = coupling::readScene(context.scenes + "/" + name + ".toml", overrides);
  if (context.frames > 0) scene.time.frames = context.frames;
  return runScene(context, scene, variant);
}

SceneRun runScene(const StudyContext& context, const coupling::Scene& scene, const std::string& variant) {
  SceneRun run;
  run.name = variant;
  run.scene = withBubblesAlone(scene);
  run.folder = context.runs + "/" + variant;
  context.runScene(run.scene, run.folder);
  run.frames = readFrameCurves(run.folder);
  requireAskedLength(run);
  const std::string checkpoints = coupling::RunFolder(run.folder).checkpoints();
  auto loaded = coupling::readNewestCheckpoint(checkpoints, run.scene);
  if (!loaded) throw coupling::FileError(checkpoints + ": holds no checkpoint");
  run.state = std::move(loaded->state);
  run.liquid = coupling::makeLiquid(run.scene, std::move(run.state.liquid));
  const foam::BubbleStore& bubbles = run.bubbles();
  foam::PowerCells().compute(bubbles.position, bubbles.radius, bubbles.id, run.topology);
  return run;
}

std::vector<CachedFrame> cachedFrames(const SceneRun& run, int firstFrame) {
  std::vector<CachedFrame> found;
  const coupling::RunFolder folder(run.folder);
  for (int frame = std::max(firstFrame, 1); frame <= run.state.frame; ++frame) {
    const std::string path = folder.bubblesPly(frame);
    if (std::filesystem::exists(path)) found.push_back({frame, coupling::readBubblesPly(path).bubbles});
  }
  return found;
}

}  // namespace spume::apps
