#include <cstdio>
#include <iostream>
#include <memory>

#include "apps/commands/commands.h"
#include "apps/duration.h"
#include "apps/exit_code.h"
#include "apps/scene_options.h"
#include "coupling/scene_builder.h"
#include "coupling/scene_lint.h"

namespace spume::apps {
namespace {

void printFindings(const std::vector<coupling::Finding>& findings) {
  for (const coupling::Finding& finding : findings)
    std::cout << (finding.severity == coupling::Severity::warning ? "warning: " : "note: ") << finding.object
              << ": " << finding.message << '\n';
}

void printCost(const coupling::Scene& scene) {
  const coupling::CostEstimate cost = coupling::estimateCost(scene);
  const auto gigabytes = [](double bytes) { return bytes / (1024.0 * 1024 * 1024); };
  std::printf("cells      %ld of %.4g mm\n", cost.cells, 1e3 * scene.dx());
  std::printf("liquid     %.4g litres at the end\n", 1e3 * cost.liquidVolume);
  std::printf("frames     %d at %g a second, about %d steps each\n", scene.time.frames, scene.time.fps,
              cost.stepsPerFrame);
  std::printf("time       about %s a frame on two cores, %s in all\n",
              formatDuration(cost.secondsPerFrame).c_str(),
              formatDuration(cost.secondsPerFrame * scene.time.frames).c_str());
  std::printf("memory     about %.2g GB\n", gigabytes(cost.memoryBytes));
  std::printf("disk       about %.2g GB\n", gigabytes(cost.diskBytes));
}

int check(const SceneOptions& options) {
  const coupling::Scene scene = options.read();
  coupling::checkObjects(scene);
  std::cout << options.path << ": " << (scene.title.empty() ? scene.name : scene.title) << '\n';
  printFindings(coupling::lintScene(scene));
  std::cout << std::flush;
  printCost(scene);
  return kDone;
}

int printKeys() {
  std::cout << coupling::describeSceneKeys();
  return kDone;
}

}  // namespace

void addCheck(CLI::App& program, Action& action) {
  CLI::App* verb =
      program.add_subcommand("check", "Reads a scene, warns of what will not work well, estimates its cost.");
  const auto options = std::make_shared<SceneOptions>();
  const auto keys = std::make_shared<bool>(false);
  options->addTo(*verb);
  verb->get_option("scene")->required(false);
  verb->add_flag("--keys", *keys, "print every key of a scene file: type, default, range, unit, meaning");
  verb->footer(
      "Examples:\n"
      "  spume check data/scenes/pouring.toml\n"
      "  spume check data/scenes/pouring.toml --resolution 128\n"
      "  spume check --keys");
  verb->callback([options, keys, &action] {
    if (!*keys && options->path.empty()) throw CLI::RequiredError("scene");
    action = [options, keys] { return *keys ? printKeys() : check(*options); };
  });
}

}  // namespace spume::apps
