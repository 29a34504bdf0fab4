#pragma once

#include "apps/preview/image.h"
#include "apps/preview/preview_scene.h"

namespace spume::apps {

/// The picture of a scene. The same input gives the same bytes on any number of threads.
Image renderPreview(const PreviewScene& scene, const PreviewSettings& settings);

}  // namespace spume::apps
