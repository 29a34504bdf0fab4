#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>

#include "apps/commands/commands.h"
#include "apps/exit_code.h"
#include "apps/report.h"
#include "coupling/bubble_cache.h"
#include "coupling/cache_listing.h"
#include "coupling/liquid_cache.h"

namespace spume::apps {
namespace {

namespace fs = std::filesystem;

void describeStamp(const coupling::FrameStamp& stamp, Report& report) {
  report.add("frame", stamp.frame);
  report.add("time", stamp.time, "s");
  report.add("fps", stamp.fps, "frames a second");
}

void describeLiquid(const coupling::LiquidFrame& frame, Report& report) {
  const fluid::GridSpec& grid = frame.liquid.grid;
  report.add("cells_x", grid.cells.x());
  report.add("cells_y", grid.cells.y());
  report.add("cells_z", grid.cells.z());
  report.add("dx", grid.dx, "m");
  report.add("liquid_volume", coupling::cachedLiquidVolume(frame), "m^3");
}

void describeBubbles(const foam::BubbleStore& bubbles, Report& report) {
  double gas = 0, least = 0, most = 0;
  std::array<std::size_t, 3> count{};
  for (std::size_t b = 0; b < bubbles.size(); ++b) {
    gas += bubbles.gas[b];
    least = b ? std::min(least, bubbles.radius[b]) : bubbles.radius[b];
    most = std::max(most, bubbles.radius[b]);
    ++count[static_cast<std::size_t>(bubbles.type[b])];
  }
  report.add("bubbles", static_cast<double>(bubbles.size()));
  report.add("bubbles_liquid", static_cast<double>(count[0]));
  report.add("bubbles_surface", static_cast<double>(count[1]));
  report.add("bubbles_air", static_cast<double>(count[2]));
  report.add("gas", gas, "m^3");
  report.add("radius_min", least, "m");
  report.add("radius_max", most, "m");
}

/// A VDB file of either kind: the file's name says which to try.
void describeVdb(const std::string& path, Report& report) {
  if (fs::path(path).filename().string().starts_with("bubbles")) {
    const coupling::BubbleFrame frame = coupling::readBubblesVdb(path);
    describeStamp(frame.stamp, report);
    describeBubbles(frame.bubbles, report);
  } else {
    const coupling::LiquidFrame frame = coupling::readLiquidFrame(path);
    describeStamp(frame.stamp, report);
    describeLiquid(frame, report);
  }
}

void describeFile(const std::string& path, Report& report) {
  if (path.ends_with(".vdb")) return describeVdb(path, report);
  if (!path.ends_with(".ply"))
    throw coupling::SceneError(path + ": expected a run's folder, a .vdb or a .ply file");
  const coupling::BubbleFrame frame = coupling::readBubblesPly(path);
  describeStamp(frame.stamp, report);
  describeBubbles(frame.bubbles, report);
}

void describeFolder(const std::string& path, Report& report) {
  const coupling::CacheListing liquid = coupling::listCache(path + "/liquid", "liquid", "vdb");
  const coupling::CacheListing bubbles = coupling::listCache(path + "/bubbles", "bubbles", "vdb");
  const coupling::CacheListing plain = coupling::listCache(path + "/bubbles", "bubbles", "ply");
  const coupling::CacheListing films = coupling::listCache(path + "/films", "films", "ply");
  const coupling::CacheListing pictures = coupling::listCache(path + "/preview", "preview", "png");
  if (liquid.frames.empty() && bubbles.frames.empty() && plain.frames.empty() &&
      !fs::exists(path + "/scene.toml"))
    throw coupling::SceneError(path + ": holds no run (no scene.toml, liquid/ or bubbles/)");
  report.add("liquid_frames", coupling::describeFrames(liquid));
  report.add("bubble_frames", coupling::describeFrames(bubbles.frames.empty() ? plain : bubbles));
  report.add("film_frames", coupling::describeFrames(films));
  report.add("pictures", coupling::describeFrames(pictures));
  report.add("bytes",
             static_cast<double>(liquid.bytes + bubbles.bytes + plain.bytes + films.bytes + pictures.bytes));
  if (!liquid.frames.empty()) {
    const coupling::LiquidFrame last = coupling::readLiquidFrame(liquid.paths.back());
    describeStamp(last.stamp, report);
    describeLiquid(last, report);
  }
  if (!bubbles.frames.empty())
    describeBubbles(coupling::readBubblesVdb(bubbles.paths.back()).bubbles, report);
}

int info(const std::string& path, bool json) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) throw coupling::FileError(path + ": no such file or folder");
  Report report;
  report.add("path", path);
  if (fs::is_directory(status))
    describeFolder(path, report);
  else
    describeFile(path, report);
  std::cout << (json ? report.json() : report.text());
  return kDone;
}

}  // namespace

void addInfo(CLI::App& program, Action& action) {
  CLI::App* verb = program.add_subcommand("info", "Says what a run's folder or a cache file holds.");
  const auto path = std::make_shared<std::string>();
  const auto json = std::make_shared<bool>(false);
  verb->add_option("path", *path, "folder of a run, .vdb or .ply file")->required()->type_name("PATH");
  verb->add_flag("--json", *json, "as one JSON object");
  verb->footer(
      "Examples:\n"
      "  spume info out/pouring\n"
      "  spume info out/pouring/bubbles/bubbles.0150.vdb --json");
  verb->callback([path, json, &action] { action = [path, json] { return info(*path, *json); }; });
}

}  // namespace spume::apps
