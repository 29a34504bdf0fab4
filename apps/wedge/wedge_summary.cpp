#include "apps/wedge/wedge_summary.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <sstream>

#include "apps/reproduce/csv_field.h"
#include "apps/reproduce/scene_figures.h"
#include "coupling/atomic_file.h"
#include "coupling/toml_slot.h"

namespace spume::apps {
namespace {

/// The word behind "status": in run.json.
std::string statusIn(const std::string& json) {
  constexpr char kKey[] = "\"status\": \"";
  const std::size_t key = json.find(kKey);
  if (key == std::string::npos) return "unknown";
  const std::size_t start = key + sizeof kKey - 1;
  return json.substr(start, json.find('"', start) - start);
}

/// A run that was stopped early has none of its statistics yet, or empty ones.
bool isWritten(const std::string& path) {
  std::error_code missing;
  const std::uintmax_t size = std::filesystem::file_size(path, missing);
  return !missing && size > 0;
}

double lastOf(const std::vector<double>& column) { return column.empty() ? 0 : column.back(); }

void readRun(const std::string& folder, VariantSummary& variant) {
  if (!std::filesystem::exists(folder + "/run.json")) {
    variant.status = "not begun";
    return;
  }
  variant.status = statusIn(coupling::readFile(folder + "/run.json"));
  if (!isWritten(folder + "/steps.csv") || !isWritten(folder + "/frames.csv")) return;
  const FrameCurves frames = readFrameCurves(folder);
  variant.frames = static_cast<int>(frames.size());
  variant.bubbles = lastOf(frames.bubbles);
  variant.mostBubbles = mostOf(frames.bubbles);
  variant.births = totalOf(frames.births);
  variant.contacts = lastOf(frames.contacts);
  variant.seconds = meanOf(frames.seconds);
  variant.liquidSeconds = meanOf(frames.liquidSeconds);
  variant.foamSeconds = meanOf(frames.foamSeconds);
  variant.volumeDrift = worstDrift(frames);
  variant.volumeError = mostOf(frames.worstVolume);
}

}  // namespace

WedgeSummary summarize(const std::string& folder) {
  const std::string path = folder + "/wedge.csv";
  std::istringstream lines(coupling::readFile(path));
  std::string line;
  std::getline(lines, line);
  WedgeSummary summary;
  summary.keys = csvFields(line);
  if (summary.keys.front() != "folder") throw coupling::SceneError(path + ": is not the table of a sweep");
  summary.keys.erase(summary.keys.begin());
  for (int number = 2; std::getline(lines, line); ++number) {
    std::vector<std::string> fields = csvFields(line);
    if (fields.size() != summary.keys.size() + 1)
      throw coupling::SceneError(path + ":" + std::to_string(number) + ": " + std::to_string(fields.size()) +
                                 " fields, expected " + std::to_string(summary.keys.size() + 1));
    VariantSummary variant{
        .folder = fields.front(), .values = {fields.begin() + 1, fields.end()}, .status = {}};
    readRun(folder + "/" + variant.folder, variant);
    summary.variants.push_back(std::move(variant));
  }
  return summary;
}

std::string WedgeSummary::csv() const {
  std::string text = "folder";
  for (const std::string& key : keys) text.append(",").append(csvField(key));
  text +=
      ",status,frames,bubbles,bubbles_most,births,contacts,seconds_per_frame,seconds_liquid,seconds_foam,"
      "volume_drift,volume_error_max\n";
  for (const VariantSummary& v : variants) {
    text += v.folder;
    for (const std::string& value : v.values) text.append(",").append(csvField(value));
    text.append(",").append(v.status).append(",").append(std::to_string(v.frames));
    for (const double figure : {v.bubbles, v.mostBubbles, v.births, v.contacts, v.seconds, v.liquidSeconds,
                                v.foamSeconds, v.volumeDrift, v.volumeError})
      text.append(",").append(coupling::exactText(figure));
    text += "\n";
  }
  return text;
}

std::string WedgeSummary::text() const {
  std::string text;
  for (const VariantSummary& v : variants) {
    char figures[200];
    std::snprintf(figures, sizeof figures,
                  ": %s, %d frames, %.3g s a frame, %.0f bubbles (most %.0f), liquid off by %.2g %%\n",
                  v.status.c_str(), v.frames, v.seconds, v.bubbles, v.mostBubbles, 100 * v.volumeDrift);
    text += v.folder + figures;
  }
  return text;
}

}  // namespace spume::apps
