#include "apps/commands/reproduce.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <limits>
#include <memory>

#include "apps/exit_code.h"
#include "apps/reproduce/reproduction.h"
#include "coupling/atomic_file.h"

namespace spume::apps {
namespace {

struct ReproduceOptions {
  std::vector<std::string> targets, cases;
  std::string output = "data/results";
  double maxCost = std::numeric_limits<double>::infinity();
  int frames = 0;
  bool list = false;
};

template <typename Item, typename Value>
bool contains(const std::vector<Item>& items, const Value& value) {
  return std::find(items.begin(), items.end(), value) != items.end();
}

bool isWanted(const Study& study, const ReproduceOptions& options) {
  return options.cases.empty() ? study.cost <= options.maxCost : contains(options.cases, study.key);
}

/// The tables asked for. Throws SceneError for a name or a case that does not exist.
std::vector<const Reproduction*> chosen(const ReproduceOptions& options) {
  std::vector<const Reproduction*> tables;
  std::string names, keys;
  std::vector<std::string> known;
  for (const Reproduction& table : reproductions()) {
    names += table.name + ", ";
    if (!contains(options.targets, "all") && !contains(options.targets, table.name)) continue;
    tables.push_back(&table);
    for (const Study& study : table.studies) known.push_back(study.key), keys += " " + study.key;
  }
  for (const std::string& target : options.targets)
    if (target != "all" &&
        std::none_of(tables.begin(), tables.end(), [&](auto* t) { return t->name == target; }))
      throw coupling::SceneError("unknown table " + target + ": expected one of " + names + "all");
  for (const std::string& key : options.cases)
    if (!contains(known, key)) throw coupling::SceneError("unknown case " + key + ": these are" + keys);
  return tables;
}

std::vector<ResultRow> perform(const Study& study, const StudyContext& context) {
  const auto start = std::chrono::steady_clock::now();
  std::vector<ResultRow> rows = study.run(context);
  const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
  for (ResultRow& row : rows) {
    row.study = study.key;
    if (row.title.empty()) row.title = study.title;
    row.seconds = spent.count();
  }
  return rows;
}

/// Runs the wanted cases of a table; what an earlier call wrote of the others is kept.
void make(const Reproduction& reproduction, const ReproduceOptions& options) {
  const std::string stem = options.output + "/" + reproduction.name;
  ResultTable table(reproduction.title);
  if (std::filesystem::exists(stem + ".csv")) table.readCsv(coupling::readFile(stem + ".csv"), stem + ".csv");
  coupling::createFolder(options.output);
  std::vector<std::string> keys;
  for (const Study& study : reproduction.studies) keys.push_back(study.key);
  const StudyContext context{options.output + "/" + reproduction.name, options.frames};
  for (const Study& study : reproduction.studies) {
    if (!isWanted(study, options)) continue;
    const std::vector<ResultRow> rows = perform(study, context);
    for (const ResultRow& row : rows) std::cout << summaryOf(row) << std::endl;
    table.set(study.key, rows);
    table.order(keys);
    coupling::replaceFile(stem + ".csv", table.csv());
    coupling::replaceFile(stem + ".md", table.markdown());
  }
  std::cout << stem << ".md: " << table.count(Verdict::met) << " aims met, " << table.count(Verdict::missed)
            << " missed" << std::endl;
}

int reproduce(const ReproduceOptions& options) {
  const std::vector<const Reproduction*> tables = chosen(options);
  for (const Reproduction* table : tables) {
    if (!options.list) {
      make(*table, options);
      continue;
    }
    std::cout << table->name << ": " << table->title << "\n";
    for (const Study& study : table->studies)
      std::cout << "  " << study.key << "  " << study.title << ", about " << study.cost << " s\n";
  }
  return kDone;
}

}  // namespace

void addReproduce(CLI::App& program, Action& action) {
  CLI::App* verb = program.add_subcommand(
      "reproduce", "Runs validation cases and sets our figures beside the published or exact ones.");
  const auto options = std::make_shared<ReproduceOptions>();
  verb->add_option("tables", options->targets, "liquid, or all")->required()->type_name("TABLE");
  verb->add_option("--cases", options->cases, "only these, e.g. L1,L3; the other rows of the table stay")
      ->delimiter(',')
      ->type_name("KEYS");
  verb->add_option("--max-cost", options->maxCost, "leave out cases that take longer [s]")
      ->check(CLI::PositiveNumber)
      ->type_name("S");
  verb->add_option("--frames", options->frames, "length of a scene's run; default: as the scene says")
      ->check(CLI::Range(1, 1000000))
      ->type_name("N");
  verb->add_option("-o,--output", options->output, "folder of the tables, TABLE.csv and TABLE.md")
      ->type_name("DIR")
      ->capture_default_str();
  verb->add_flag("--list", options->list, "show the cases and what they cost, run nothing");
  verb->footer(
      "Examples:\n"
      "  spume reproduce liquid --list\n"
      "  spume reproduce liquid --max-cost 60\n"
      "  spume reproduce liquid --cases F8,F9 -o out/results");
  verb->callback([options, &action] { action = [options] { return reproduce(*options); }; });
}

}  // namespace spume::apps
