#include "apps/frame_output.h"

#include "apps/preview/image.h"
#include "apps/preview/renderer.h"
#include "coupling/bubble_cache.h"
#include "coupling/drop_cache.h"
#include "coupling/film_cache.h"
#include "coupling/liquid_cache.h"
#include "coupling/scene_builder.h"
#include "coupling/shapes.h"

namespace spume::apps {

namespace {

Material materialOf(const coupling::Scene& scene, const coupling::SolidSpec& solid) {
  using enum coupling::SolidLook;
  if (scene.look.solids != automatic) return scene.look.solids == glass ? Material::glass : Material::matte;
  return solid.shape.kind == coupling::ShapeKind::vessel ? Material::glass : Material::matte;
}

}  // namespace

PreviewScene previewOf(const coupling::Scene& scene, const fluid::LiquidState& liquid,
                       const foam::BubbleStore& bubbles) {
  PreviewScene view{.grid = liquid.grid,
                    .phi = liquid.phi,
                    .lower = liquid.grid.origin,
                    .upper = liquid.grid.upper(),
                    .closed = scene.domain.closed,
                    .solids = {},
                    .bubblePosition = bubbles.position,
                    .bubbleRadius = bubbles.radius,
                    .bubbleType = bubbles.type,
                    .bubbleId = bubbles.id,
                    .bubbleAge = bubbles.age,
                    .bubbleShade = {},
                    .drops = liquid.drops,
                    .camera = scene.camera,
                    .look = scene.look};
  for (const coupling::SolidSpec& solid : scene.solids) {
    coupling::Scene alone = scene;
    alone.solids = {solid};
    view.solids.push_back({coupling::solidDistance(alone, liquid.time), materialOf(scene, solid)});
  }
  return view;
}

void writeFrame(const coupling::RunFolder& folder, const coupling::Simulation& simulation) {
  const coupling::Scene& scene = simulation.scene();
  const coupling::OutputSpec& wanted = scene.output;
  const int frame = simulation.frame();
  const coupling::FrameStamp stamp{frame, simulation.time(), scene.time.fps};
  if (frame % wanted.every == 0) {
    if (wanted.liquid)
      coupling::writeLiquidFrame(folder.liquid(frame), simulation.liquid(), simulation.solids(), stamp,
                                 {.staggeredVelocity = wanted.staggeredVelocity});
    if (wanted.bubblesVdb)
      coupling::writeBubblesVdb(folder.bubblesVdb(frame), simulation.bubbles(), stamp,
                                simulation.liquid().grid.dx);
    const std::vector<fluid::Drop>& drops = simulation.liquid().drops;
    if (wanted.dropsVdb)
      coupling::writeDropsVdb(folder.dropsVdb(frame), drops, stamp, simulation.liquid().grid.dx);
    if (wanted.dropsPly) coupling::writeDropsPly(folder.dropsPly(frame), drops, stamp);
    if (wanted.films)
      coupling::writeFilmsPly(folder.films(frame),
                              foam::soapFilms(simulation.bubbles(), *simulation.fields()),
                              simulation.bubbles().id, stamp);
    if (wanted.bubblesPly) coupling::writeBubblesPly(folder.bubblesPly(frame), simulation.bubbles(), stamp);
  }
  if (wanted.preview) {
    const PreviewSettings settings{.width = wanted.previewSize.x(), .height = wanted.previewSize.y()};
    writePng(renderPreview(previewOf(scene, simulation.liquid(), simulation.bubbles()), settings),
             folder.preview(frame));
  }
}

}  // namespace spume::apps
