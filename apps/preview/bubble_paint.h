#pragma once

#include "apps/preview/preview_scene.h"

namespace spume::apps {

/// Colour of a bubble in the diagrams, linear RGB: blue in the liquid, green at the surface, orange in air,
/// or by its shade.
Vec3 bubblePaint(const PreviewScene& scene, PreviewStyle style, int bubble);

Vec3 classColour(foam::BubbleClass type);

/// The colour map of the shades: dark blue at 0 over green to yellow at 1, even in lightness.
Vec3 shadeColour(float shade);

}  // namespace spume::apps
