#include "coupling/liquid_recording.h"

#include <algorithm>
#include <limits>

#include "coupling/atomic_file.h"
#include "coupling/checkpoint.h"
#include "coupling/foam_keys.h"
#include "coupling/kept_steps.h"
#include "coupling/run_folder.h"
#include "coupling/scene_toml.h"
#include "coupling/text_fields.h"

namespace spume::coupling {
namespace {

/// The one key of entrainment that may be changed: births that were recorded can be left out.
constexpr char kEntrains[] = "coupling.entrainment.enabled";

/// Where the columns of events.csv that a birth needs lie in its rows.
struct BirthColumns {
  std::size_t time, kind, cause, x, y, z, radius;

  static BirthColumns of(const TextLines& lines, std::string_view header) {
    std::vector<std::string_view> names;
    std::string_view name;
    for (CommaFields fields(header); fields.next(name);) names.push_back(name);
    const auto column = [&](std::string_view wanted) {
      const auto found = std::find(names.begin(), names.end(), wanted);
      if (found == names.end()) lines.fail(header, "has no column " + std::string(wanted));
      return static_cast<std::size_t>(found - names.begin());
    };
    return {column("time"), column("kind"), column("cause"), column("x"),
            column("y"),    column("z"),    column("radius")};
  }
  std::size_t last() const { return std::max({time, kind, cause, x, y, z, radius}); }
};

std::vector<RecordedBirth> readBirths(const std::string& path) {
  const std::string contents = readFile(path);
  TextLines lines(path, contents);
  std::string_view line, cell;
  std::vector<RecordedBirth> births;
  if (!lines.next(line)) return births;
  const BirthColumns column = BirthColumns::of(lines, line);
  std::vector<std::string_view> cells;
  while (lines.next(line)) {
    cells.clear();
    for (CommaFields fields(line); fields.next(cell);) cells.push_back(cell);
    if (cells.size() <= column.last()) lines.fail(line, "is cut off");
    if (cells[column.kind] != "birth") continue;
    const std::string_view cause = cells[column.cause];
    if (cause != "marker" && cause != "pocket") continue;
    const auto number = [&](std::size_t n, const char* name) { return numberIn(lines, cells[n], name); };
    births.push_back({number(column.time, "time"),
                      {number(column.x, "x"), number(column.y, "y"), number(column.z, "z")},
                      number(column.radius, "radius"),
                      cause == "marker" ? BirthCause::marker : BirthCause::pocket});
  }
  return births;
}

/// Whether the recorded liquid, or what it bore, would be another with another value of `key`.
bool shapesTheLiquid(const std::string& key) {
  constexpr std::string_view kTables[] = {"domain.",      "liquid.", "still_pool.", "solid.",
                                          "liquid_body.", "inflow.", "outflow."};
  if (key == "time.fps") return true;
  if (key.starts_with("coupling.entrainment.")) return key != kEntrains;
  const auto isOf = [&](std::string_view table) { return key.starts_with(table); };
  if (std::none_of(std::begin(kTables), std::end(kTables), isOf)) return false;
  const std::string name = key.substr(key.rfind('.') + 1);
  const std::vector<KeyRow> surface = wallTable().keys;  // how bubbles take to a solid is the foam's
  const auto isNamed = [&](const KeyRow& row) { return row.name == name; };
  return !key.starts_with("solid.") || std::none_of(surface.begin(), surface.end(), isNamed);
}

}  // namespace

LiquidRecording::LiquidRecording(const std::string& folder)
    : folder_(folder),
      frames_(listCache(folder + "/liquid", "liquid", "vdb")),
      steps_(readKeptSteps(folder + "/steps.csv", std::numeric_limits<int>::max())) {
  if (frames_.frames.empty())
    throw SceneError(folder +
                     ": holds no cached liquid (liquid/liquid.####.vdb); run the scene into it first, "
                     "with output.liquid = true");
  if (steps_.empty()) throw FileError(folder + "/steps.csv: is missing or empty: this is no run's folder");
  births_ = readBirths(folder + "/events.csv");
}

void LiquidRecording::requireSameLiquid(const Scene& scene) const {
  std::string message;
  for (const std::string& difference :
       sceneDifferences(readFile(folder_ + "/scene.toml"), writeScene(scene))) {
    const std::string key = difference.substr(0, difference.find(' '));
    const bool asksForBirths = key == kEntrains && scene.coupling.entrainment.enabled;  // none were recorded
    if (asksForBirths || shapesTheLiquid(key)) message += " " + difference + ";";
  }
  if (message.empty()) return;
  message.pop_back();
  throw SceneError(folder_ +
                   ": its liquid is another than the scene's; undo the difference, or run the scene "
                   "itself:" +
                   message);
}

}  // namespace spume::coupling
