#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>

#include "apps/commands/commands.h"
#include "apps/duration.h"
#include "apps/run_session.h"
#include "apps/scene_options.h"
#include "apps/stop_request.h"
#include "apps/wedge/shell_word.h"
#include "apps/wedge/wedge_folder.h"

namespace spume::apps {
namespace {

namespace fs = std::filesystem;

struct WedgeOptions {
  SceneOptions scene;
  std::vector<std::string> vary;
  std::string output, summary, maxWall = "4h";
  int threads = 4;  ///< of a job
  bool slurm = false, run = false;
};

/// The program that is running, so that scripts find it from any folder.
std::string thisProgram() {
  std::error_code error;
  const fs::path path = fs::read_symlink("/proc/self/exe", error);
  return error ? "spume" : path.string();
}

void printWarnings(const Wedge& wedge) {
  for (const SharedFinding& shared : warningsOf(wedge)) {
    std::cout << "warning: " << shared.finding.object << ": " << shared.finding.message;
    if (shared.folders.size() < wedge.variants.size())
      std::cout << " (" << shared.folders.size() << " of the variants, first " << shared.folders.front()
                << ")";
    std::cout << '\n';
  }
}

void printPlan(const Wedge& wedge, const WedgeOptions& options) {
  for (const WedgeVariant& variant : wedge.variants) std::cout << variant.folder << '\n';
  printWarnings(wedge);
  const WedgeCost cost = costOf(wedge);
  constexpr double kGigabyte = 1024.0 * 1024 * 1024;
  std::cout << std::flush;
  std::printf("%zu variants: about %s on two cores in all, %.2g GB on disk, %.2g GB of memory each\n",
              wedge.variants.size(), formatDuration(cost.seconds).c_str(), cost.diskBytes / kGigabyte,
              cost.memoryBytes / kGigabyte);
  std::fflush(stdout);
  if (!options.run)
    std::cout << "sh " << shellWord(options.output + "/commands.sh") << " runs them"
              << (options.slurm ? ", sbatch " + shellWord(options.output + "/wedge.sbatch") + " queues them"
                                : "")
              << std::endl;
}

/// Writes summary.csv and says what it holds.
int summarizeAndPrint(const std::string& folder) {
  const WedgeSummary summary = summarize(folder);
  writeSummary(summary, folder);
  std::cout << summary.text() << folder << "/summary.csv: " << summary.variants.size() << " variants"
            << std::endl;
  return kDone;
}

/// As commands.sh does. One that fails does not hold up the others; the code is that of the first.
int runAll(const Wedge& wedge, const std::string& folder) {
  int code = kDone, number = 0;
  for (const WedgeVariant& variant : wedge.variants) {
    std::cout << "variant " << ++number << " of " << wedge.variants.size() << ": " << variant.folder
              << std::endl;
    try {
      runToTheEnd(variant.scene, folder + "/" + variant.folder, false);
    } catch (const Stopped&) {
      throw;
    } catch (const std::exception& error) {
      std::cerr << "spume: " << variant.folder << ": " << error.what() << std::endl;
      if (code == kDone) code = exitCodeOf(error);
    }
  }
  summarizeAndPrint(folder);
  return code;
}

int wedge(WedgeOptions options) {
  if (!options.summary.empty()) return summarizeAndPrint(options.summary);
  std::vector<Variation> variations;
  for (const std::string& text : options.vary) variations.push_back(parseVariation(text));
  const Wedge wedge = makeWedge(variations, [&](const coupling::Overrides& overrides) {
    for (const coupling::Override& one : overrides) options.scene.requireNew(one);
    return options.scene.read(overrides);
  });
  if (options.output.empty()) options.output = "out/" + wedge.name() + "_wedge";
  std::optional<SlurmRequest> slurm;
  if (options.slurm)
    slurm = SlurmRequest{thisProgram(), fs::absolute(options.output).lexically_normal().string(),
                         parseDuration(options.maxWall), options.threads, costOf(wedge).memoryBytes};
  writeWedge(wedge, options.output, thisProgram(), slurm);
  printPlan(wedge, options);
  return options.run ? runAll(wedge, options.output) : kDone;
}

void addOptions(CLI::App& verb, WedgeOptions& options) {
  options.scene.addTo(verb);
  verb.get_option("scene")->required(false);
  verb.add_option(
          "--vary", options.vary,
          "a key and its values, as --set takes them; may be repeated: every combination is a variant")
      ->type_name("a.b=v,w,...")
      ->type_size(1)
      ->allow_extra_args(false);
  verb.add_option("-o,--output", options.output, "folder of the sweep; default out/<scene name>_wedge")
      ->type_name("DIR");
  CLI::Option* slurm = verb.add_flag("--slurm", options.slurm, "write wedge.sbatch, a job array, too");
  verb.add_option("--max-wall", options.maxWall,
                  "time of a job; one that needs longer is queued again and goes on")
      ->check(CLI::Validator(durationProblem, "TIME"))
      ->needs(slurm)
      ->capture_default_str();
  verb.add_option("--threads", options.threads, "cores of a job")
      ->check(CLI::Range(1, 4096))
      ->needs(slurm)
      ->type_name("N")
      ->capture_default_str();
  verb.add_flag("--run", options.run, "run the variants here, one after the other");
  verb.add_option("--summary", options.summary,
                  "write nothing but summary.csv of a sweep: what came out, a row a variant")
      ->type_name("DIR");
}

/// What is missing or too much on the command line.
void checkUse(const WedgeOptions& options) {
  if (!options.summary.empty()) {
    if (options.scene.path.empty() && options.vary.empty()) return;
    throw CLI::ExcludesError("--summary", "SCENE and --vary");
  }
  if (options.scene.path.empty()) throw CLI::RequiredError("scene");
  if (options.vary.empty()) throw CLI::RequiredError("--vary");
}

}  // namespace

void addWedge(CLI::App& program, Action& action) {
  CLI::App* verb =
      program.add_subcommand("wedge", "Prepares a parameter sweep: a folder and a command a variant.");
  const auto options = std::make_shared<WedgeOptions>();
  addOptions(*verb, *options);
  verb->footer(
      "Checks every variant before anything is written, then writes into DIR: a folder a variant with its\n"
      "scene, variant.toml; wedge.csv, which folder has which values; commands.sh, which runs the variants "
      "one\n"
      "after the other, goes on with what is unfinished, is not held up by a variant that fails, and closes\n"
      "with summary.csv.\n"
      "Examples:\n"
      "  spume wedge data/scenes/pouring.toml --vary liquid.cfl=2,4 --vary foam.wetness=0.2,0.4 -o out/look\n"
      "  spume wedge scene.toml --vary foam.volume_mode=relax,newton --quality draft --run\n"
      "  spume wedge scene.toml --vary 'inflow.0.direction=[0,-1,0],[0.2,-1,0]' --slurm --max-wall 3h\n"
      "  spume wedge --summary out/look");
  verb->callback([options, &action] {
    checkUse(*options);
    action = [options] { return wedge(*options); };
  });
}

}  // namespace spume::apps
