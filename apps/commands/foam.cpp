#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>

#include "apps/commands/commands.h"
#include "apps/scene_options.h"
#include "apps/session_arguments.h"
#include "coupling/liquid_recording.h"

namespace spume::apps {
namespace {

struct FoamOptions {
  std::string folder, frames, seed;
  std::vector<std::string> set;
  SessionArguments session;
};

/// The scene of a run with its liquid read from that run, over the frames that are there.
coupling::Scene sceneOf(const FoamOptions& options) {
  SceneOptions scene;
  scene.path = options.folder + "/scene.toml";
  scene.seed = options.seed;
  scene.frames = options.frames;
  scene.set = options.set;
  scene.set.push_back("liquid_cache.run=" +
                      std::filesystem::absolute(options.folder).lexically_normal().string());
  coupling::Scene foam = scene.read();
  const int last = coupling::listCache(options.folder + "/liquid", "liquid", "vdb").lastFrame();
  if (options.frames.empty() && last > 0) foam.time.frames = std::min(foam.time.frames, last);
  return foam;
}

/// Probes of a pressure have nothing to read: caches hold none.
void dropPressureProbes(coupling::Scene& scene) {
  const auto isOfPressure = [](const coupling::ProbeSpec& p) {
    return p.kind == coupling::ProbeKind::pressure;
  };
  if (std::erase_if(scene.probes, isOfPressure) > 0)
    std::cout << "warning: probes of a pressure are left out: a cached liquid holds none" << std::endl;
}

int foam(const FoamOptions& options) {
  coupling::Scene scene = sceneOf(options);
  dropPressureProbes(scene);
  std::string folder = options.folder;
  while (folder.size() > 1 && folder.back() == '/') folder.pop_back();
  const std::string target = options.session.output.empty() ? folder + "_foam" : options.session.output;
  std::error_code ignored;
  if (std::filesystem::equivalent(target, folder, ignored))
    throw coupling::SceneError("-o " + target + ": is the folder whose liquid is read; name another");
  return options.session.run(std::move(scene), folder + "_foam");
}

}  // namespace

void addFoam(CLI::App& program, Action& action) {
  CLI::App* verb = program.add_subcommand(
      "foam", "Computes the foam of a run again on its cached liquid, which takes the liquid's time off.");
  const auto options = std::make_shared<FoamOptions>();
  verb->add_option("folder", options->folder, "folder of a finished run")->required()->type_name("DIR");
  verb->add_option("--frames", options->frames, "frames to simulate; default: as many as are cached")
      ->type_name("N");
  verb->add_option("--seed", options->seed, "of the random numbers; scene.seed")->type_name("N");
  verb->add_option(
          "--set", options->set,
          "any key about bubbles, e.g. --set foam.wetness=0.6; those of the liquid, of solids and of "
          "what is entrained stay as they were; may be repeated")
      ->type_name("a.b=v")
      ->type_size(1)
      ->allow_extra_args(false);
  options->session.addTo(*verb, "<DIR>_foam");
  verb->footer(
      "Between cached frames the liquid is blended along its velocity: cache every frame (output.every = 1)\n"
      "where it is fast. Bubbles that its motion bore are born where and when they were.\n"
      "Examples:\n"
      "  spume foam out/coke -o out/dry --set foam.wetness=0.2\n"
      "  spume foam out/pouring -o out/long_lived --set foam.burst_median_life=20");
  verb->callback([options, &action] { action = [options] { return foam(*options); }; });
}

}  // namespace spume::apps
