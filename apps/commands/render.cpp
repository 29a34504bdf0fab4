#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>

#include "apps/commands/commands.h"
#include "apps/duration.h"
#include "apps/exit_code.h"
#include "apps/frame_output.h"
#include "apps/preview/bubble_shade.h"
#include "apps/preview/image.h"
#include "apps/preview/movie.h"
#include "apps/preview/renderer.h"
#include "coupling/atomic_file.h"
#include "coupling/bubble_cache.h"
#include "coupling/cache_listing.h"
#include "coupling/drop_cache.h"
#include "coupling/liquid_cache.h"
#include "coupling/scene_toml.h"
#include "coupling/stopwatch.h"
#include "coupling/vdb_liquid_sampler.h"
#include "foam/soap_films.h"

namespace spume::apps {
namespace {

namespace fs = std::filesystem;

struct RenderOptions {
  std::string folder, frames, size = "960x720", style = "beauty", films;
  int samples = 2;
};

/// The two numbers of "A<separator>B", both at least 1; nothing if the text is of another form.
std::optional<std::pair<int, int>> numberPair(const std::string& text, char separator) {
  std::pair<int, int> pair{0, 0};
  const char* end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, pair.first);
  if (first.ec != std::errc{} || first.ptr == end || *first.ptr != separator) return {};
  const auto second = std::from_chars(first.ptr + 1, end, pair.second);
  if (second.ec != std::errc{} || second.ptr != end || pair.first < 1 || pair.second < 1) return {};
  return pair;
}

std::string sizeProblem(const std::string& text) {
  constexpr int kLeast = 16, kMost = 16384;  // pixels; the limits of PreviewSettings
  const auto size = numberPair(text, 'x');
  const bool fits =
      size && std::min(size->first, size->second) >= kLeast && std::max(size->first, size->second) <= kMost;
  return fits ? "" : "\"" + text + "\" is no size: write WxH in pixels, each 16 to 16384, e.g. 1920x1080";
}

std::string framesProblem(const std::string& text) {
  const auto range = numberPair(text.find('-') == std::string::npos ? text + "-" + text : text, '-');
  return range && range->first <= range->second
             ? ""
             : "\"" + text + "\" are no frames: write A-B or A, e.g. 30-60";
}

std::pair<int, int> framesOf(const std::string& text) {
  if (text.empty()) return {0, std::numeric_limits<int>::max()};
  return *numberPair(text.find('-') == std::string::npos ? text + "-" + text : text, '-');
}

/// Path without extension of the `kind` file of a frame, from that of its liquid file.
std::string siblingOf(const std::string& folder, const std::string& kind, const std::string& liquidPath) {
  std::string name = fs::path(liquidPath).stem().string();  // liquid.0001
  name.replace(0, name.find('.'), kind);
  return folder + "/" + kind + "/" + name;
}

/// Bubbles of a frame from whichever cache the run wrote; none if it wrote neither.
foam::BubbleStore bubblesOf(const std::string& folder, const std::string& liquidPath) {
  const std::string path = siblingOf(folder, "bubbles", liquidPath);
  if (fs::exists(path + ".vdb")) return coupling::readBubblesVdb(path + ".vdb").bubbles;
  if (fs::exists(path + ".ply")) return coupling::readBubblesPly(path + ".ply").bubbles;
  return {};
}

std::vector<fluid::Drop> dropsOf(const std::string& folder, const std::string& liquidPath) {
  const std::string path = siblingOf(folder, "drops", liquidPath);
  if (fs::exists(path + ".ply")) return coupling::readDropsPly(path + ".ply");
  if (fs::exists(path + ".vdb")) return coupling::readDropsVdb(path + ".vdb");
  return {};
}

constexpr std::array<const char*, 4> kStyleNames{"beauty", "classes", "contacts", "pressure"};  // as the enum

PreviewStyle styleNamed(const std::string& name) {
  return static_cast<PreviewStyle>(std::find(kStyleNames.begin(), kStyleNames.end(), name) -
                                   kStyleNames.begin());
}

/// Says which frames asked for cannot be drawn, or are drawn without their bubbles, because a cache lacks
/// them. Where no frames were asked for, those between the first and the last cached one are.
void warnOfGaps(const coupling::Scene& scene, const std::string& folder, const coupling::CacheListing& cache,
                int first, int last) {
  if (cache.frames.empty()) return;
  if (last == std::numeric_limits<int>::max()) first = cache.frames.front(), last = cache.frames.back();
  std::vector<int> absent, bare;
  const int every = scene.output.every;
  for (int frame = (first + every - 1) / every * every; frame <= last; frame += every)
    if (!std::binary_search(cache.frames.begin(), cache.frames.end(), frame)) absent.push_back(frame);
  for (std::size_t f = 0; f < cache.frames.size(); ++f) {
    const std::string path = siblingOf(folder, "bubbles", cache.paths[f]);
    const bool drawn = cache.frames[f] >= first && cache.frames[f] <= last;
    if (drawn && !fs::exists(path + ".vdb") && !fs::exists(path + ".ply")) bare.push_back(cache.frames[f]);
  }
  if (!absent.empty())
    std::cout << "warning: no cached liquid for " << coupling::describeNumbers(absent) << ": left out"
              << std::endl;
  if (!bare.empty())
    std::cout << "warning: no cached bubbles for " << coupling::describeNumbers(bare) << ": drawn without"
              << std::endl;
}

/// Draws one cached frame.
void renderFrame(const coupling::Scene& scene, const std::string& folder, const std::string& liquidPath,
                 const PreviewSettings& settings, const std::string& path) {
  coupling::LiquidFrame liquid = coupling::readLiquidFrame(liquidPath);
  liquid.liquid.drops = dropsOf(folder, liquidPath);
  const foam::BubbleStore bubbles = bubblesOf(folder, liquidPath);
  const std::vector<double> shade = bubbleShade(settings.style, scene.foam, bubbles);
  PreviewScene view = previewOf(scene, liquid.liquid, bubbles);
  view.bubbleShade = shade;
  std::optional<foam::SoapFilms> films;
  if (scene.look.films == coupling::FilmLook::curved && settings.style == PreviewStyle::beauty) {
    films = foam::soapFilms(bubbles,
                            coupling::VdbLiquidSampler(liquid, scene.liquid.density, scene.liquid.gravity));
    view.films = &*films;
  }
  writePng(renderPreview(view, settings), path);
}

int render(const RenderOptions& options) {
  const coupling::Stopwatch watch;
  coupling::Scene scene = coupling::readScene(options.folder + "/scene.toml");
  if (!options.films.empty())
    scene.look.films = options.films == "curved" ? coupling::FilmLook::curved : coupling::FilmLook::plane;
  const coupling::CacheListing cache = coupling::listCache(options.folder + "/liquid", "liquid", "vdb");
  const auto [first, last] = framesOf(options.frames);
  const auto [width, height] = *numberPair(options.size, 'x');
  const PreviewSettings settings{
      .width = width, .height = height, .samples = options.samples, .style = styleNamed(options.style)};
  const std::string target = options.folder + "/render";
  int done = 0;
  for (std::size_t f = 0; f < cache.frames.size(); ++f) {
    if (cache.frames[f] < first || cache.frames[f] > last) continue;
    if (done++ == 0) coupling::createFolder(target);
    const std::string number = fs::path(cache.paths[f]).stem().extension().string();  // .0001
    const std::string path = target + "/" + options.style + number + ".png";
    renderFrame(scene, options.folder, cache.paths[f], settings, path);
    std::cout << path << std::endl;
  }
  if (done > 0) warnOfGaps(scene, options.folder, cache, first, last);
  if (done == 0)
    throw coupling::SceneError(options.folder + ": no cached liquid in these frames; it holds " +
                               coupling::describeFrames(cache));
  const std::string problem =
      done > 1 ? writeMovie(target + "/" + options.style, scene.time.fps / scene.output.every,
                            target + "/" + options.style + ".mp4")
               : "";
  if (!problem.empty()) std::cout << problem << '\n';
  std::cout << "done: " << done << " pictures in " << formatDuration(watch.seconds()) << std::endl;
  return kDone;
}

}  // namespace

void addRender(CLI::App& program, Action& action) {
  CLI::App* verb = program.add_subcommand(
      "render", "Draws pictures, and a movie where ffmpeg is installed, from a run's caches.");
  const auto options = std::make_shared<RenderOptions>();
  verb->add_option("folder", options->folder, "folder of a run")->required()->type_name("DIR");
  verb->add_option("--frames", options->frames, "A-B or A; default all")
      ->check(CLI::Validator(framesProblem, "A-B"));
  verb->add_option("--size", options->size, "pixels; default 960x720")
      ->check(CLI::Validator(sizeProblem, "WxH"));
  verb->add_option("--style", options->style,
                   "beauty; classes: blue in the liquid, green at the surface, orange in air; contacts: "
                   "their number, 0 dark to 14 yellow; pressure: of the neighbours over capillary, 0 to 1")
      ->check(CLI::IsMember(std::vector<std::string>(kStyleNames.begin(), kStyleNames.end())));
  verb->add_option(
          "--films", options->films,
          "plane: the faces of the cells; curved: as soap films are, half a second per 1000 bubbles; "
          "default: look.films of the scene")
      ->check(CLI::IsMember({"plane", "curved"}));
  verb->add_option("--samples", options->samples, "per pixel and axis, 1 to 8; default 2")
      ->check(CLI::Range(1, 8));
  verb->footer(
      "Examples:\n"
      "  spume render out/pouring\n"
      "  spume render out/pouring --frames 90 --size 1920x1440 --samples 3\n"
      "  spume render out/pouring --style pressure\n"
      "  spume render out/soap --frames 240 --films curved");
  verb->callback([options, &action] { action = [options] { return render(*options); }; });
}

}  // namespace spume::apps
