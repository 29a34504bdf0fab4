#include "apps/cache_report.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <vector>

#include "coupling/bubble_cache.h"
#include "coupling/cache_kind.h"
#include "coupling/cache_listing.h"
#include "coupling/drop_cache.h"
#include "coupling/film_cache.h"
#include "coupling/liquid_cache.h"

namespace spume::apps {
namespace {

namespace fs = std::filesystem;
using coupling::CacheKind;
using coupling::CacheListing;

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

/// Smallest and largest; 0 of nothing.
void describeRadii(const std::string& prefix, const std::vector<double>& radii, Report& report) {
  const auto [least, most] = std::minmax_element(radii.begin(), radii.end());
  report.add(prefix + "radius_min", radii.empty() ? 0 : *least, "m");
  report.add(prefix + "radius_max", radii.empty() ? 0 : *most, "m");
}

void describeBubbles(const foam::BubbleStore& bubbles, Report& report) {
  double gas = 0;
  std::array<std::size_t, 3> count{};
  for (std::size_t b = 0; b < bubbles.size(); ++b) {
    gas += bubbles.gas[b];
    ++count[static_cast<std::size_t>(bubbles.type[b])];
  }
  report.add("bubbles", static_cast<double>(bubbles.size()));
  report.add("bubbles_liquid", static_cast<double>(count[0]));
  report.add("bubbles_surface", static_cast<double>(count[1]));
  report.add("bubbles_air", static_cast<double>(count[2]));
  report.add("gas", gas, "m^3");
  describeRadii("", bubbles.radius, report);
}

void describeDrops(const std::vector<fluid::Drop>& drops, Report& report) {
  double volume = 0;
  std::vector<double> radii;
  for (const fluid::Drop& drop : drops) {
    volume += drop.volume;
    radii.push_back(coupling::radiusOf(drop));
  }
  report.add("drops", static_cast<double>(drops.size()));
  report.add("drop_volume", volume, "m^3");
  describeRadii("drop_", radii, report);
}

void describeFilms(const coupling::FilmTotals& totals, Report& report) {
  report.add("films", static_cast<double>(totals.films));
  report.add("film_area", totals.area, "m^2");
  report.add("triangles", static_cast<double>(totals.triangles));
  report.add("vertices", static_cast<double>(totals.vertices));
}

void describeContents(const std::string& path, CacheKind kind, Report& report) {
  const bool isVdb = path.ends_with(".vdb");
  switch (kind) {
    case CacheKind::liquid:
      return describeLiquid(coupling::readLiquidFrame(path), report);
    case CacheKind::bubbles:
      return describeBubbles(
          (isVdb ? coupling::readBubblesVdb(path) : coupling::readBubblesPly(path)).bubbles, report);
    case CacheKind::drops:
      return describeDrops(isVdb ? coupling::readDropsVdb(path) : coupling::readDropsPly(path), report);
    case CacheKind::films:
      return describeFilms(coupling::readFilmTotals(path), report);
  }
}

/// Those of the two kinds of file that there are; of both, the VDB.
const CacheListing& eitherOf(const CacheListing& vdb, const CacheListing& ply) {
  return vdb.frames.empty() ? ply : vdb;
}

}  // namespace

void describeFile(const std::string& path, Report& report) {
  const bool isVdb = path.ends_with(".vdb");
  if (!isVdb && !path.ends_with(".ply"))
    throw coupling::SceneError(path + ": expected a run's folder, a .vdb or a .ply file");
  const coupling::CacheLabel label = isVdb ? coupling::labelOfVdb(path) : coupling::labelOfPly(path);
  describeStamp(label.stamp, report);
  describeContents(path, label.kind, report);
}

void describeFolder(const std::string& path, Report& report) {
  std::uintmax_t bytes = 0;
  const auto list = [&](const std::string& kind, const std::string& extension) {
    CacheListing listing = coupling::listCache(path + "/" + kind, kind, extension);
    bytes += listing.bytes;
    return listing;
  };
  const CacheListing liquid = list("liquid", "vdb"), films = list("films", "ply"),
                     pictures = list("preview", "png"), checkpoints = list("checkpoint", "bin"),
                     bubblesVdb = list("bubbles", "vdb"), bubblesPly = list("bubbles", "ply"),
                     dropsVdb = list("drops", "vdb"), dropsPly = list("drops", "ply");
  const CacheListing &bubbles = eitherOf(bubblesVdb, bubblesPly), &drops = eitherOf(dropsVdb, dropsPly);
  if (liquid.frames.empty() && bubbles.frames.empty() && !fs::exists(path + "/scene.toml"))
    throw coupling::SceneError(path + ": holds no run (no scene.toml, liquid/ or bubbles/)");
  report.add("liquid_frames", coupling::describeFrames(liquid));
  report.add("bubble_frames", coupling::describeFrames(bubbles));
  report.add("drop_frames", coupling::describeFrames(drops));
  report.add("film_frames", coupling::describeFrames(films));
  report.add("pictures", coupling::describeFrames(pictures));
  report.add("checkpoints",
             checkpoints.frames.empty() ? "none" : coupling::describeNumbers(checkpoints.frames));
  report.add("bytes", static_cast<double>(bytes));
  const CacheListing& dated = liquid.frames.empty() ? bubbles : liquid;
  if (dated.frames.empty()) return;
  const std::string& last = dated.paths.back();
  describeStamp((last.ends_with(".vdb") ? coupling::labelOfVdb(last) : coupling::labelOfPly(last)).stamp,
                report);
  if (!liquid.frames.empty()) describeContents(liquid.paths.back(), CacheKind::liquid, report);
  if (!bubbles.frames.empty()) describeContents(bubbles.paths.back(), CacheKind::bubbles, report);
  if (!drops.frames.empty()) describeContents(drops.paths.back(), CacheKind::drops, report);
}

}  // namespace spume::apps
