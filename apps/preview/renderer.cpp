#include "apps/preview/renderer.h"

#include <tbb/blocked_range2d.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "apps/preview/camera.h"
#include "apps/preview/legend.h"
#include "apps/preview/tone.h"
#include "apps/preview/tracer.h"

namespace spume::apps {
namespace {

constexpr int kSolidCells = 64;  // along the box, times detail
constexpr int kMostDetail = 3;   // of the light map; more shows in no picture

/// The picture while it is computed: display values, so that strong highlights do not alias.
class Canvas {
 public:
  Canvas(const Tracer& tracer, const Camera& camera, const PreviewSettings& settings)
      : tracer_(tracer),
        camera_(camera),
        settings_(settings),
        pixel_(std::size_t(settings.width) * settings.height) {}

  void render();
  void refineEdges();
  Image image() const;

 private:
  Vec3 sample(int x, int y, int samples) const;
  bool isEdge(int x, int y) const;
  const Vec3& at(int x, int y) const { return pixel_[std::size_t(y) * settings_.width + x]; }
  template <typename Body>
  void forEachPixel(const Body& body) const {
    constexpr int kTile = 16;
    tbb::parallel_for(tbb::blocked_range2d<int>(0, settings_.height, kTile, 0, settings_.width, kTile),
                      [&](const tbb::blocked_range2d<int>& tile) {
                        for (int y = tile.rows().begin(); y < tile.rows().end(); ++y)
                          for (int x = tile.cols().begin(); x < tile.cols().end(); ++x) body(x, y);
                      });
  }

  const Tracer& tracer_;
  const Camera& camera_;
  const PreviewSettings& settings_;
  std::vector<Vec3> pixel_;
};

Vec3 Canvas::sample(int x, int y, int samples) const {
  Vec3 sum = Vec3::Zero();
  for (int a = 0; a < samples; ++a)
    for (int b = 0; b < samples; ++b)
      sum += toDisplay(tracer_.radiance(
          camera_.eye(), camera_.direction(x + (a + 0.5f) / samples, y + (b + 0.5f) / samples)));
  return sum / static_cast<float>(samples * samples);
}

/// One ray a pixel: smooth parts need no more.
void Canvas::render() {
  forEachPixel([&](int x, int y) { pixel_[std::size_t(y) * settings_.width + x] = sample(x, y, 1); });
}

bool Canvas::isEdge(int x, int y) const {
  constexpr float kContrast = 0.10f;  // of display values, about the smallest step the eye sees as a jag
  const Vec3& here = at(x, y);
  const auto differs = [&](int u, int v) {
    if (u < 0 || v < 0 || u >= settings_.width || v >= settings_.height) return false;
    return (at(u, v) - here).cwiseAbs().maxCoeff() > kContrast;
  };
  for (int v = y - 1; v <= y + 1; ++v)
    for (int u = x - 1; u <= x + 1; ++u)
      if (differs(u, v)) return true;
  return false;
}

/// Pixels that differ from one of their eight neighbours get a whole lattice of rays.
void Canvas::refineEdges() {
  std::vector<Vec3> refined = pixel_;
  forEachPixel([&](int x, int y) {
    if (isEdge(x, y)) refined[std::size_t(y) * settings_.width + x] = sample(x, y, settings_.samples + 1);
  });
  pixel_.swap(refined);
}

Image Canvas::image() const {
  Image image(settings_.width, settings_.height);
  for (std::size_t p = 0; p < pixel_.size(); ++p)
    for (int c = 0; c < 3; ++c)
      image.rgb[3 * p + c] =
          static_cast<std::uint8_t>(std::lround(255 * std::clamp(pixel_[p][c], 0.0f, 1.0f)));
  return image;
}

/// What an automatic camera shows: the box of glass or, where there is none, the solids.
Eigen::AlignedBox3f shownBox(const GlassBox& box, const std::vector<SurfaceMesh>& solids) {
  Eigen::AlignedBox3f shown;
  if (!box.isDrawn())
    for (const SurfaceMesh& solid : solids)
      for (const Vec3& corner : solid.position) shown.extend(corner);
  if (shown.isEmpty()) shown = {box.outerLower(), box.outerUpper()};
  return shown;
}

}  // namespace

Image renderPreview(const PreviewScene& scene, const PreviewSettings& settings) {
  const GlassBox box(scene);
  const BubbleCells cells(scene);
  std::vector<SurfaceMesh> solids;
  for (const PreviewSolid& solid : scene.solids)
    solids.push_back(meshDistance(solid.distance, scene.lower, scene.upper,
                                  kSolidCells * std::min(settings.samples, kMostDetail)));
  const Camera camera(scene.camera, shownBox(box, solids), settings.width, settings.height);
  const RayScene rays(scene, cells, meshLevelSet(scene.grid, scene.phi, scene.lower, scene.upper),
                      std::move(solids));
  std::optional<FilmSurfaces> films;
  if (scene.films && settings.style == PreviewStyle::beauty)
    films.emplace(*scene.films, scene.bubblePosition.size(), rays.offset());
  const Optics optics(scene, box, cells, films ? &*films : nullptr, rays,
                      settings.style != PreviewStyle::beauty);
  Environment environment(box, scene.look.backdrop);
  environment.setLightMap(
      LightMap(optics, box, Environment::keyDirection(), std::min(settings.samples, kMostDetail)));
  const Tracer tracer(scene, settings.style, optics, environment);
  Canvas canvas(tracer, camera, settings);
  canvas.render();
  canvas.refineEdges();
  Image image = canvas.image();
  drawLegend(settings.style, image);
  return image;
}

}  // namespace spume::apps
