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

namespace fs = std::filesystem;

struct FoamOptions {
  std::string folder;
  SceneOptions scene;
  SessionArguments session;
};

/// The folder with its own name last, however it was given ("run/", ".").
fs::path namedFolder(const std::string& folder) {
  const fs::path whole = fs::absolute(folder).lexically_normal();
  return whole.has_filename() ? whole : whole.parent_path();
}

/// The scene of a run with its liquid read from that run; over the frames that are there, if nobody says
/// otherwise.
coupling::Scene sceneOf(SceneOptions options, const fs::path& folder) {
  constexpr std::string_view kFrames = "time.frames=";
  const bool asksForFrames = !options.frames.empty() ||
                             std::any_of(options.set.begin(), options.set.end(),
                                         [&](const std::string& set) { return set.starts_with(kFrames); });
  options.path = (folder / "scene.toml").string();
  if (coupling::readScene(options.path).stillPool.enabled)
    throw coupling::SceneError(
        folder.string() + ": has no solved liquid, but a pool at rest; run its scene with --set instead");
  options.set.push_back("liquid_cache.run=" + folder.string());
  coupling::Scene scene = options.read();
  const int last = coupling::listCache((folder / "liquid").string(), "liquid", "vdb").lastFrame();
  if (!asksForFrames && last > 0) scene.time.frames = std::min(scene.time.frames, last);
  return scene;
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
  const fs::path folder = namedFolder(options.folder);
  coupling::Scene scene = sceneOf(options.scene, folder);
  dropPressureProbes(scene);
  const std::string target =
      options.session.output.empty() ? folder.string() + "_foam" : options.session.output;
  if (namedFolder(target) == folder)
    throw coupling::SceneError("-o " + target + ": is the folder whose liquid is read; name another");
  return options.session.run(std::move(scene), target);
}

}  // namespace

void addFoam(CLI::App& program, Action& action) {
  CLI::App* verb = program.add_subcommand(
      "foam", "Computes the foam of a run again on its cached liquid, which takes the liquid's time off.");
  const auto options = std::make_shared<FoamOptions>();
  verb->add_option("folder", options->folder, "folder of a run; its frames so far are used")
      ->required()
      ->type_name("DIR");
  options->scene.addChangesTo(
      *verb,
      "any key about bubbles, e.g. --set foam.wetness=0.6; those of the liquid, of solids and of what is "
      "entrained stay as they were");
  options->session.addTo(*verb, "<DIR>_foam");
  verb->footer(
      "Runs over the frames that are cached, unless --frames asks for fewer.\n"
      "Between cached frames the liquid is blended along its velocity: cache every frame (output.every = 1)\n"
      "where it is fast. Bubbles that its motion bore are born where and when they were.\n"
      "Examples:\n"
      "  spume foam out/coke -o out/dry --set foam.wetness=0.2\n"
      "  spume foam out/pouring -o out/long_lived --set foam.burst_median_life=20");
  verb->callback([options, &action] { action = [options] { return foam(*options); }; });
}

}  // namespace spume::apps
