#include "apps/commands/reproduce.h"

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <limits>
#include <memory>

#include "apps/exit_code.h"
#include "apps/reproduce/selection.h"
#include "apps/run_session.h"
#include "apps/stop_request.h"
#include "coupling/atomic_file.h"
#include "coupling/stopwatch.h"

namespace spume::apps {
namespace {

struct ReproduceOptions {
  std::vector<std::string> targets, cases;
  std::string output = "data/results", scenes = "data/scenes", runs = "out/reproduce";
  double maxCost = std::numeric_limits<double>::infinity();
  int frames = 0;
  bool list = false, restart = false;
};

StudyContext contextOf(const Reproduction& table, const ReproduceOptions& options) {
  StudyContext context{options.output + "/" + table.name, options.frames, options.scenes, options.runs, {}};
  context.runScene = [restart = options.restart](const coupling::Scene& scene, const std::string& folder) {
    runToTheEnd(scene, folder, restart);
  };
  return context;
}

std::vector<ResultRow> perform(const Study& study, const StudyContext& context) {
  const coupling::Stopwatch watch;
  std::vector<ResultRow> rows = study.run(context);
  for (ResultRow& row : rows) {
    row.study = study.key;
    if (row.title.empty()) row.title = study.title;
    row.seconds = watch.seconds();
  }
  return rows;
}

/// The table, with the plots its cases have made so far.
std::string pageOf(const Reproduction& reproduction, const ResultTable& table, const std::string& folder) {
  std::string page = table.markdown();
  for (const auto& [file, caption] : reproduction.plots)
    if (std::filesystem::exists(folder + "/" + reproduction.name + "/" + file))
      page += "\n![" + caption + "](" + reproduction.name + "/" + file + ")\n*" + caption + "*\n";
  return page;
}

ResultTable readTable(const Reproduction& reproduction, const std::string& folder) {
  ResultTable table(reproduction.title);
  const std::string path = folder + "/" + reproduction.name + ".csv";
  if (std::filesystem::exists(path)) table.readCsv(coupling::readFile(path), path);
  return table;
}

/// Runs the wanted cases of a table; what an earlier call wrote of the others is kept. A table of which none
/// is wanted is left alone.
void make(const Selection& selection, const ReproduceOptions& options) {
  const Reproduction& reproduction = *selection.table;
  if (std::none_of(reproduction.studies.begin(), reproduction.studies.end(),
                   [&](const Study& study) { return selection.wants(study, options.maxCost); }))
    return;
  const std::string stem = options.output + "/" + reproduction.name;
  coupling::createFolder(options.output);
  ResultTable table = readTable(reproduction, options.output);
  const StudyContext context = contextOf(reproduction, options);
  for (const Study& study : reproduction.studies) {
    if (!selection.wants(study, options.maxCost)) continue;
    const std::vector<ResultRow> rows = perform(study, context);
    for (const ResultRow& row : rows) std::cout << summaryOf(row) << std::endl;
    table.set(study.key, rows);
    table.order(keysOf(reproduction));
    coupling::replaceFile(stem + ".csv", table.csv());
    coupling::replaceFile(stem + ".md", pageOf(reproduction, table, options.output));
  }
  std::cout << stem << ".md: " << table.count(Verdict::met) << " aims met, " << table.count(Verdict::missed)
            << " missed" << std::endl;
}

/// reproduce.md: every table that the folder holds, on one page.
void writeReport(const std::string& folder) {
  std::string page;
  for (const Reproduction& reproduction : reproductions())
    if (const ResultTable table = readTable(reproduction, folder); !table.rows().empty())
      page += (page.empty() ? "" : "\n") + pageOf(reproduction, table, folder);
  coupling::replaceFile(folder + "/reproduce.md", page);
}

void list(const Reproduction& table) {
  std::cout << table.name << ": " << table.title << "\n";
  for (const Study& study : table.studies)
    std::cout << "  " << study.key << "  " << study.title << ", about " << study.cost << " s\n";
}

int reproduce(const ReproduceOptions& options) {
  const std::vector<Selection> selections = select(reproductions(), options.targets, options.cases);
  try {
    for (const Selection& selection : selections)
      options.list ? list(*selection.table) : make(selection, options);
  } catch (const Stopped& stopped) {
    return tellStopped(stopped, options.restart);
  }
  if (!options.list) writeReport(options.output);
  return kDone;
}

}  // namespace

void addReproduce(CLI::App& program, Action& action) {
  CLI::App* verb = program.add_subcommand(
      "reproduce", "Runs validation cases and sets our figures beside the published or exact ones.");
  const auto options = std::make_shared<ReproduceOptions>();
  verb->add_option("tables", options->targets,
                   "liquid, foam, scenes, one of cluster, soap, pouring, coke, coke_100k, or all")
      ->required()
      ->type_name("TABLE");
  verb->add_option("--cases", options->cases, "only these, e.g. L1,L3; the other rows of the table stay")
      ->delimiter(',')
      ->type_name("KEYS");
  verb->add_option("--max-cost", options->maxCost, "leave out cases that take longer [s]")
      ->check(CLI::PositiveNumber)
      ->type_name("S");
  verb->add_option("--frames", options->frames, "length of a scene's run; default: as the scene says")
      ->check(CLI::Range(1, 1000000))
      ->type_name("N");
  verb->add_option("-o,--output", options->output, "folder of the tables and plots")
      ->type_name("DIR")
      ->capture_default_str();
  verb->add_option("--scenes", options->scenes, "folder of the scene files")
      ->type_name("DIR")
      ->capture_default_str();
  verb->add_option("--runs", options->runs, "folder the scenes run in; what is there already is gone on with")
      ->type_name("DIR")
      ->capture_default_str();
  verb->add_flag("--restart", options->restart, "run the scenes anew");
  verb->add_flag("--list", options->list, "show the cases and what they cost, run nothing");
  verb->footer(
      "Writes TABLE.csv, TABLE.md, plots in TABLE/, and reproduce.md with all tables of the folder. A scene "
      "that\n"
      "was interrupted goes on when the same command is given again; with more --frames it is continued.\n"
      "Examples:\n"
      "  spume reproduce all --list\n"
      "  spume reproduce cluster soap\n"
      "  spume reproduce coke --frames 150\n"
      "  spume reproduce liquid --max-cost 60\n"
      "  spume reproduce liquid --cases F8,F9 -o out/results");
  verb->callback([options, &action] { action = [options] { return reproduce(*options); }; });
}

}  // namespace spume::apps
