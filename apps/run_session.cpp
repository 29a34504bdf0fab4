#include "apps/run_session.h"

#include <tbb/global_control.h>

#include <cstdio>
#include <iostream>
#include <memory>

#include "apps/duration.h"
#include "apps/frame_output.h"
#include "apps/log.h"
#include "apps/preview/movie.h"
#include "apps/progress.h"
#include "coupling/checkpoint.h"
#include "coupling/folder_lock.h"
#include "coupling/kept_steps.h"
#include "coupling/probes.h"
#include "coupling/run_folder.h"
#include "coupling/scene_builder.h"
#include "coupling/scene_lint.h"
#include "coupling/statistics.h"
#include "coupling/stopwatch.h"
#include "coupling/unfinished_run.h"

namespace spume::apps {
namespace {

using coupling::FrameReport;
using coupling::Simulation;
using coupling::StepReport;

/// One run on one folder. The members are built in order: nothing is written before the scene proved sound.
class Session {
 public:
  explicit Session(const SessionOptions& options);
  ExitCode run();

 private:
  bool finished() const { return simulation_->frame() >= options_.scene.time.frames; }
  void recall(int step, int frame);
  void begin();
  void advance(Progress& progress, const StopRequest& stop);
  template <typename Rows>
  void addRows(const Rows& report);
  void writeCheckpoint();
  void leaveCheckpoint();
  void writeSummary(const std::string& status);
  void finish();

  const SessionOptions& options_;
  const coupling::Stopwatch watch_;
  coupling::RunFolder folder_;
  const coupling::FolderLock lock_;
  std::unique_ptr<Simulation> simulation_;
  std::unique_ptr<coupling::StatisticsWriter> statistics_;
  std::unique_ptr<Log> log_;
  coupling::RunSummary summary_;
  int written_ = 0;                ///< last frame whose files are whole: only then it is done
  bool rowsWhole_ = true;          ///< the tables have a row of every step taken
  std::vector<StepReport> begun_;  ///< steps a resumed run has behind it of the frame it goes on in
};

/// Checks what can be checked without a folder, then makes the folder.
coupling::RunFolder prepareFolder(const SessionOptions& options) {
  coupling::checkObjects(options.scene);
  coupling::RunFolder::requireNoForeignFile(options.folder, options.restart);
  return coupling::RunFolder(options.folder);
}

Session::Session(const SessionOptions& options)
    : options_(options), folder_(prepareFolder(options)), lock_(folder_.root()) {
  std::optional<coupling::LoadedCheckpoint> loaded;
  if (!options.restart) loaded = coupling::readNewestCheckpoint(folder_.checkpoints(), options.scene);
  int step = 0, frame = 0;
  using enum coupling::Beginning;
  coupling::Beginning beginning = afresh;
  if (loaded) {
    step = loaded->state.step;
    frame = written_ = loaded->state.frame;
    simulation_ = std::make_unique<Simulation>(options.scene, std::move(loaded->state));
  } else {
    if (!options.restart) beginning = coupling::beginningIn(folder_, options.scene);
    simulation_ = std::make_unique<Simulation>(options.scene);
    if (beginning == afresh) folder_.clear();
  }
  summary_.threads = options.threads;
  summary_.switchedOff = coupling::switchedOff(options.scene);
  if (!loaded) writeSummary(summary_.status);
  log_ = std::make_unique<Log>(folder_.log());
  if (!lock_.warning().empty()) log_->say("warning: " + lock_.warning());
  if (loaded) {
    for (const std::string& warning : loaded->warnings) log_->say("warning: " + warning);
    if (!finished()) log_->say("going on from " + loaded->path);
  }
  if (beginning == again) log_->say("no checkpoint yet: begins again at the first frame");
  folder_.writeScene(options.scene);
  recall(step, frame);
  statistics_ = std::make_unique<coupling::StatisticsWriter>(folder_.root(), step, frame,
                                                             coupling::probeColumns(options.scene));
}

/// Takes up the totals of a run that had got to `step` and had finished `frame`.
void Session::recall(int step, int frame) {
  if (step == 0) return;
  FrameReport finished{.frame = frame, .time = frame / options_.scene.time.fps, .steps = {}};
  const double kRoundOff = 1e-9;
  for (StepReport& report : coupling::readKeptSteps(folder_.root() + "/steps.csv", step))
    (report.time <= finished.time * (1 + kRoundOff) ? finished.steps : begun_).push_back(std::move(report));
  coupling::accumulate(summary_, finished);
  summary_.frames = frame;
}

void Session::begin() {
  const coupling::Scene& scene = options_.scene;
  char text[160];
  std::snprintf(text, sizeof text, "%s: %dx%dx%d cells of %.3g mm, %d frames at %g a second, %d threads",
                scene.name.c_str(), simulation_->liquid().grid.cells.x(),
                simulation_->liquid().grid.cells.y(), simulation_->liquid().grid.cells.z(),
                1e3 * simulation_->liquid().grid.dx, scene.time.frames, scene.time.fps, options_.threads);
  log_->say(text);
  for (const coupling::Finding& finding : coupling::lintScene(scene))
    if (finding.severity == coupling::Severity::warning)
      log_->say("warning: " + finding.object + ": " + finding.message);
}

void Session::advance(Progress& progress, const StopRequest& stop) {
  const coupling::Stopwatch watch;
  const int frame = simulation_->frame() + 1;
  FrameReport report = simulation_->advanceFrame([&](const StepReport& step) {
    addRows(step);
    progress.step(frame, step);
    if (step.halvings > 0)
      log_->write("step " + std::to_string(step.step) + ": halved " + std::to_string(step.halvings) +
                  " times");
    stop.check();
  });
  report.steps.insert(report.steps.begin(), begun_.begin(), begun_.end());
  begun_.clear();
  writeFrame(folder_, *simulation_);
  addRows(report);
  written_ = frame;
  coupling::accumulate(summary_, report);
  if (finished() || simulation_->frame() % options_.scene.output.checkpointEvery == 0) writeCheckpoint();
  progress.frame(report, watch.seconds());
}

/// Until its rows are in the tables nobody may go on from after a step or a frame.
template <typename Rows>
void Session::addRows(const Rows& report) {
  rowsWhole_ = false;
  statistics_->add(report);
  rowsWhole_ = true;
}

/// A frame that could not be written is taken up again at its end, without a step, to be written.
void Session::writeCheckpoint() {
  coupling::SimulationState state = simulation_->state();
  state.frame = written_;
  coupling::writeCheckpoint(folder_.checkpoints(), options_.scene, state);
  writeSummary("running");
}

/// Of a run that failed: its state is that between two steps, as a failed step takes itself back.
void Session::leaveCheckpoint() {
  if (!rowsWhole_) return;
  try {
    writeCheckpoint();
    writeSummary("failed");
  } catch (const std::exception& error) {  // the same full disk or lack of memory, like as not
    log_->write(std::string("no checkpoint: ") + error.what());
  }
}

void Session::writeSummary(const std::string& status) {
  summary_.status = status;
  summary_.wallSeconds = watch_.seconds();
  summary_.bubbles = simulation_->bubbles().size();
  coupling::writeRunJson(folder_.runJson(), options_.scene, summary_);
}

void Session::finish() {
  if (options_.scene.output.preview) {
    const std::string problem =
        writeMovie(folder_.root() + "/preview/preview", options_.scene.time.fps, folder_.movie());
    if (!problem.empty()) log_->say(problem);
  }
  writeSummary("done");
  const std::string problem = coupling::volumeWarning(summary_, simulation_->liquid().grid.cellVolume());
  if (!problem.empty()) log_->say("warning: " + problem);
  for (const std::string& warning : coupling::unplacedWarnings(options_.scene, simulation_->supply().sources))
    log_->say("warning: " + warning);
  log_->say("done: frame " + std::to_string(simulation_->frame()) + " after " +
            formatDuration(watch_.seconds()) + ", " + std::to_string(simulation_->bubbles().size()) +
            " bubbles; see " + folder_.root());
}

ExitCode Session::run() {
  if (finished()) {
    log_->say("nothing to do: " + folder_.root() + " holds all " +
              std::to_string(options_.scene.time.frames) + " frames; --restart runs them again");
    return kDone;
  }
  begin();
  try {
    const StopRequest stop(options_.maxWall);
    Progress progress(options_.scene.time.frames, Progress::onTerminal());
    while (!finished()) advance(progress, stop);
  } catch (const Stopped& stopped) {
    writeCheckpoint();
    writeSummary("stopped");
    log_->say(std::string(stopped.what()) + " in frame " + std::to_string(simulation_->frame() + 1) + "; " +
              wayOn(options_.restart) + " from the checkpoint");
    return stopped.code();
  } catch (const std::exception& error) {
    log_->write(error.what());
    leaveCheckpoint();
    throw;
  }
  finish();
  return kDone;
}

}  // namespace

ExitCode runSession(const SessionOptions& options) { return Session(options).run(); }

int allowedThreads() {
  using tbb::global_control;
  return static_cast<int>(global_control::active_value(global_control::max_allowed_parallelism));
}

void runToTheEnd(const coupling::Scene& scene, const std::string& folder, bool restart) {
  SessionOptions session;
  session.scene = scene;
  session.folder = folder;
  session.restart = restart;
  session.threads = allowedThreads();
  if (const ExitCode code = runSession(session); code != kDone) throw Stopped(code);
}

int tellStopped(const Stopped& stopped, bool restart) {
  std::cerr << "spume: " << stopped.what() << "; " << wayOn(restart)
            << (restart ? "; runs not yet begun anew stay as they were" : "") << std::endl;
  return stopped.code();
}

}  // namespace spume::apps
