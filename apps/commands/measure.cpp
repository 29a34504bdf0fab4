#include <array>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <utility>

#include "apps/commands/commands.h"
#include "apps/exit_code.h"
#include "apps/report.h"
#include "coupling/bubble_table.h"
#include "coupling/cell_table.h"
#include "coupling/film_cache.h"
#include "coupling/stopwatch.h"
#include "foam/power_cells.h"
#include "foam/power_diagram.h"
#include "foam/soap_films.h"

namespace spume::apps {
namespace {

struct MeasureOptions {
  std::string bubbles, cells, contacts, films;
  std::string engine = "local";
  bool json = false;
};

bool sameFile(const std::string& a, const std::string& b) {
  std::error_code unknown;
  const auto whole = [&](const std::string& path) {
    return std::filesystem::weakly_canonical(path, unknown);
  };
  return !a.empty() && !b.empty() && whole(a) == whole(b);
}

/// No file may replace another of the same call.
void checkPaths(const MeasureOptions& options) {
  const std::array<std::pair<const char*, std::string>, 3> written{
      {{"--output", options.cells}, {"--contacts", options.contacts}, {"--films", options.films}}};
  for (std::size_t a = 0; a < written.size(); ++a) {
    for (std::size_t b = a + 1; b < written.size(); ++b)
      if (sameFile(written[a].second, written[b].second))
        throw coupling::SceneError(std::string(written[a].first) + " and " + written[b].first +
                                   " are the same file, " + written[a].second);
    if (sameFile(written[a].second, options.bubbles))
      throw coupling::SceneError(written[a].second + " would replace the bubbles it is measured from");
  }
}

/// Curved films are relaxed from the cells of the local engine.
void checkEngine(const MeasureOptions& options) {
  if (!options.films.empty() && options.engine != "local")
    throw coupling::SceneError("--films needs --engine local: leave --engine " + options.engine +
                               " out, or write the films by a call of their own");
}

Report reportOf(const coupling::FoamTotals& totals, double geometrySeconds, double seconds) {
  Report report;
  report.add("bubbles", static_cast<double>(totals.bubbles));
  report.add("hidden", static_cast<double>(totals.hidden));
  report.add("contacts", static_cast<double>(totals.contacts));
  report.add("volume", totals.volume, "m^3");
  report.add("free_area", totals.freeArea, "m^2");
  report.add("film_area", totals.filmArea, "m^2");
  report.add("geometry_seconds", geometrySeconds, "s");
  report.add("seconds", seconds, "s");
  return report;
}

foam::FoamTopology topologyOf(const coupling::BubbleTable& bubbles, const std::string& engine) {
  foam::FoamTopology topology;
  if (engine == "global")
    foam::PowerDiagram().compute(bubbles.position, bubbles.radius, bubbles.id, topology);
  else
    foam::PowerCells().compute(bubbles.position, bubbles.radius, bubbles.id, topology);
  return topology;
}

foam::BubbleStore storeOf(const coupling::BubbleTable& table) {
  foam::BubbleStore bubbles;
  for (std::size_t n = 0; n < table.id.size(); ++n) {
    bubbles.add({.position = table.position[n], .radius = table.radius[n]});
    bubbles.id.back() = table.id[n];
  }
  return bubbles;
}

int measure(const MeasureOptions& options) {
  const coupling::Stopwatch whole;
  checkPaths(options);
  checkEngine(options);
  const coupling::BubbleTable bubbles = coupling::readBubbleTable(options.bubbles);
  if (const std::string words = coupling::wordsOnUnread(options.bubbles, bubbles); !words.empty())
    std::cerr << "warning: " << words << '\n';
  const coupling::Stopwatch geometry;
  const foam::FoamTopology topology = topologyOf(bubbles, options.engine);
  const double geometrySeconds = geometry.seconds();
  if (!options.cells.empty()) coupling::writeCellTable(options.cells, bubbles, topology);
  if (!options.contacts.empty()) coupling::writeContactTable(options.contacts, bubbles, topology);
  if (!options.films.empty())
    coupling::writeFilmsPly(options.films, foam::soapFilms(storeOf(bubbles)), bubbles.id, {});
  const Report report = reportOf(coupling::totalsOf(topology), geometrySeconds, whole.seconds());
  std::cout << (options.json ? report.json() : report.text());
  return kDone;
}

}  // namespace

void addMeasure(CLI::App& program, Action& action) {
  CLI::App* verb = program.add_subcommand(
      "measure", "Volume, areas, films and contacts of any set of balls, cut by their power diagram.");
  const auto options = std::make_shared<MeasureOptions>();
  verb->add_option("bubbles", options->bubbles,
                   "balls in metres: .csv with a header id,x,y,z,r, or .ply, or .vdb points")
      ->required()
      ->type_name("BUBBLES");
  verb->add_option("-o,--output", options->cells,
                   "a row per bubble: id,volume,free_area,film_area,films,hidden")
      ->type_name("CSV");
  verb->add_option("--contacts", options->contacts, "a row per film: id_a,id_b,distance,film_area")
      ->type_name("CSV");
  verb->add_option("--films", options->films,
                   "the films as a mesh, curved as soap films are: faces with id_a,id_b,curvature; half a "
                   "second per 1000 balls; with --engine local")
      ->type_name("PLY");
  verb->add_option("--engine", options->engine,
                   "local: from overlapping neighbours; global: the triangulation of all balls, a slow check")
      ->check(CLI::IsMember({"local", "global"}))
      ->capture_default_str();
  verb->add_flag("--json", options->json, "totals as one JSON object");
  verb->footer(
      "The totals are those of the union of the balls; film_area counts each film once.\n"
      "Examples:\n"
      "  spume measure balls.csv -o cells.csv --contacts contacts.csv\n"
      "  spume measure out/pouring/bubbles/bubbles.0150.ply\n"
      "  spume measure out/soap/bubbles/bubbles.0240.ply --films films.ply");
  verb->callback([options, &action] { action = [options] { return measure(*options); }; });
}

}  // namespace spume::apps
