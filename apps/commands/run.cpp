#include <tbb/global_control.h>

#include <memory>
#include <optional>

#include "apps/commands/commands.h"
#include "apps/duration.h"
#include "apps/exit_code.h"
#include "apps/run_session.h"
#include "apps/scene_options.h"

namespace spume::apps {
namespace {

struct RunOptions {
  SceneOptions scene;
  std::string output, maxWall;
  int threads = 0;  ///< 0: one per core
  bool restart = false, noPreview = false;
};

int run(const RunOptions& options) {
  SessionOptions session;
  session.scene = options.scene.read();
  if (options.noPreview) session.scene.output.preview = false;
  session.folder = options.output.empty() ? "out/" + session.scene.name : options.output;
  session.restart = options.restart;
  session.threads =
      options.threads > 0
          ? options.threads
          : static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
  if (!options.maxWall.empty()) session.maxWall = parseDuration(options.maxWall);
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, session.threads);
  return runSession(session);
}

/// CLI11's form of a check: an empty string, or what is wrong.
std::string durationProblem(const std::string& text) {
  try {
    parseDuration(text);
    return {};
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
}

}  // namespace

void addRun(CLI::App& program, Action& action) {
  CLI::App* verb =
      program.add_subcommand("run", "Simulates a scene; on a folder that holds a run, goes on with it.");
  const auto options = std::make_shared<RunOptions>();
  options->scene.addTo(*verb);
  verb->add_option("-o,--output", options->output, "folder for caches and pictures; default out/<scene name>")
      ->type_name("DIR");
  verb->add_option("--threads", options->threads, "default: one per core; results do not depend on it")
      ->check(CLI::Range(1, 4096))
      ->type_name("N");
  verb->add_option("--max-wall", options->maxWall,
                   "stop with a checkpoint and exit code 75 after e.g. 3h or 90m")
      ->check(CLI::Validator(durationProblem, "TIME"));
  verb->add_flag("--restart", options->restart,
                 "start anew and remove what an earlier run left in the folder");
  verb->add_flag("--no-preview", options->noPreview, "no picture per frame");
  verb->footer(
      "Examples:\n"
      "  spume run data/scenes/pouring.toml\n"
      "  spume run data/scenes/pouring.toml --quality draft --frames 30 -o out/try --restart\n"
      "  spume run scene.toml --set foam.wetness=0.6 --max-wall 3h");
  verb->callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace spume::apps
