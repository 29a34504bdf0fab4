#include <memory>

#include "apps/commands/commands.h"
#include "apps/scene_options.h"
#include "apps/session_arguments.h"

namespace spume::apps {
namespace {

struct RunOptions {
  SceneOptions scene;
  SessionArguments session;
};

int run(const RunOptions& options) {
  const coupling::Scene scene = options.scene.read();
  return options.session.run(scene, "out/" + scene.name);
}

}  // namespace

void addRun(CLI::App& program, Action& action) {
  CLI::App* verb =
      program.add_subcommand("run", "Simulates a scene; on a folder that holds a run, goes on with it.");
  const auto options = std::make_shared<RunOptions>();
  options->scene.addTo(*verb);
  options->session.addTo(*verb, "out/<scene name>");
  verb->footer(
      "Examples:\n"
      "  spume run data/scenes/pouring.toml\n"
      "  spume run data/scenes/pouring.toml --quality draft --frames 30 -o out/try --restart\n"
      "  spume run scene.toml --set foam.wetness=0.6 --max-wall 3h");
  verb->callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace spume::apps
