#include <filesystem>
#include <iostream>
#include <memory>

#include "apps/commands/commands.h"
#include "apps/run_session.h"
#include "apps/scene_options.h"
#include "apps/stop_request.h"
#include "apps/trade/trade_page.h"
#include "apps/trade/trade_plot.h"
#include "apps/trade/trade_table.h"
#include "apps/wedge/shell_word.h"
#include "coupling/atomic_file.h"

namespace spume::apps {
namespace {

// What runs where no scene is named: every dial and term in a quarter of an hour on two cores.
constexpr char kScene[] = "data/scenes/pouring.toml", kResolution[] = "40", kFrames[] = "60";

struct TradeOptions {
  SceneOptions scene;
  std::vector<std::string> dials;
  std::string output = "out/trade", runs = "out/trade/runs";
  int seeds = 5;
  bool list = false, restart = false;
};

void useDefaultScene(SceneOptions& scene) {
  scene.path = kScene;
  if (scene.resolution.empty() && scene.quality.empty()) scene.resolution = kResolution;
  if (scene.frames.empty()) scene.frames = kFrames;
}

/// The command that makes the same page.
std::string commandOf(const TradeOptions& options) {
  const SceneOptions& scene = options.scene;
  std::string text = "spume trade " + shellWord(scene.path);
  for (const auto& [option, value] : {std::pair{" --quality ", scene.quality},
                                      {" --resolution ", scene.resolution},
                                      {" --frames ", scene.frames},
                                      {" --seed ", scene.seed}})
    if (!value.empty()) text += option + value;
  for (const std::string& assignment : scene.set) text += " --set " + shellWord(assignment);
  text += " --seeds " + std::to_string(options.seeds);
  std::string names;
  for (const std::string& name : options.dials) names.append(names.empty() ? "" : ",").append(name);
  return names.empty() ? text : text + " --dials " + names;
}

int list(const std::vector<Dial>& dials) {
  for (const Dial& dial : dials) {
    std::cout << dial.name << ": " << dial.title << ":";
    for (const DialSetting& setting : dial.settings) std::cout << ' ' << setting.label;
    std::cout << '\n';
  }
  return kDone;
}

void write(const Trade& trade, const TradeOptions& options) {
  coupling::createFolder(options.output);
  const std::string name = "trade_" + trade.scene.name, stem = options.output + "/" + name;
  coupling::replaceFile(stem + ".csv", tradeTable(trade).csv());
  coupling::replaceFile(stem + ".svg", tradePlot(trade));
  const std::string page = stem + ".md";
  const std::string reading = std::filesystem::exists(page) ? readingOf(coupling::readFile(page)) : "";
  coupling::replaceFile(page, tradePage(trade, name + ".svg", commandOf(options), reading));
  std::cout << stem << ".md, .csv and .svg are written" << std::endl;
}

int trade(TradeOptions options) {
  if (options.scene.path.empty()) useDefaultScene(options.scene);
  const TradePlan plan{[&](const coupling::Overrides& changes) { return options.scene.read(changes); },
                       options.dials, options.seeds};
  const coupling::Scene own = plan.read({});
  if (options.list) return list(selectDials(dialsOf(own), options.dials));
  StudyContext context;
  context.runs = options.runs + "/" + own.name;
  context.runScene = [&](const coupling::Scene& scene, const std::string& folder) {
    std::cout << folder << std::endl;
    runToTheEnd(scene, folder, options.restart);
  };
  try {
    write(runTrade(plan, context), options);
  } catch (const Stopped& stopped) {
    return tellStopped(stopped, options.restart);
  }
  return kDone;
}

void addOptions(CLI::App& verb, TradeOptions& options) {
  options.scene.addTo(verb);
  verb.get_option("scene")->required(false);
  verb.add_option("--dials", options.dials, "only these, or liquid, foam, terms; --list names them")
      ->delimiter(',')
      ->type_name("NAMES");
  verb.add_option("--seeds", options.seeds, "runs of the scene itself that the noise is taken from")
      ->check(CLI::Range(kFewestSeeds, kMostSeeds))
      ->type_name("N")
      ->capture_default_str();
  verb.add_option("-o,--output", options.output, "folder of table, page and plot")
      ->type_name("DIR")
      ->capture_default_str();
  verb.add_option("--runs", options.runs, "folder of the runs; finished ones are not run again")
      ->type_name("DIR")
      ->capture_default_str();
  verb.add_flag("--restart", options.restart, "run everything anew");
  verb.add_flag("--list", options.list, "show the dials and terms of the scene, run nothing");
}

}  // namespace

void addTrade(CLI::App& program, Action& action) {
  CLI::App* verb = program.add_subcommand(
      "trade", "Speed against accuracy: turns every dial of a scene and switches off every term.");
  const auto options = std::make_shared<TradeOptions>();
  addOptions(*verb, *options);
  verb->footer(
      "Runs the scene with several seeds, with every dial at its finest, and with one dial turned or one "
      "term\n"
      "switched at a time; says which change nothing beyond the noise. Writes trade_NAME.md, .csv and .svg.\n"
      "Without SCENE: pouring with 40 cells along an edge, 60 frames; a quarter of an hour. Times are those "
      "of\n"
      "the runs as they went: nothing else should run beside them.\n"
      "Examples:\n"
      "  spume trade\n"
      "  spume trade data/scenes/soap.toml --frames 200 --list\n"
      "  spume trade scene.toml --quality draft --frames 60 --dials cfl,step,terms");
  verb->callback([options, &action] { action = [options] { return trade(*options); }; });
}

}  // namespace spume::apps
