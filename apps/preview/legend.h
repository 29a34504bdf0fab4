#pragma once

#include "apps/preview/image.h"
#include "apps/preview/preview_scene.h"

namespace spume::apps {

/// Draws what the colours of a diagram mean into its lower left corner; nothing for the style beauty.
void drawLegend(PreviewStyle style, Image& image);

}  // namespace spume::apps
