#pragma once

#include "apps/preview/preview_scene.h"

namespace spume::apps {

/// Linear radiance to display values 0..1: a film-like curve (dark toe, soft shoulder), then the sRGB curve.
Vec3 toDisplay(const Vec3& light);

}  // namespace spume::apps
