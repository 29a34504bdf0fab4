#include "apps/preview/bubble_paint.h"

#include <algorithm>

namespace spume::apps {

Vec3 shadeColour(float shade) {
  // Linear RGB; lightness grows evenly and the order is kept for colour-blind eyes.
  static const Vec3 kStops[] = {{0.055f, 0.018f, 0.105f}, {0.052f, 0.078f, 0.26f}, {0.014f, 0.23f, 0.27f},
                                {0.105f, 0.47f, 0.165f},  {0.55f, 0.70f, 0.035f},  {0.98f, 0.80f, 0.02f}};
  constexpr int kLast = std::size(kStops) - 1;
  const float x = std::clamp(shade, 0.0f, 1.0f) * kLast;
  const int stop = std::min(static_cast<int>(x), kLast - 1);
  return kStops[stop] + (x - stop) * (kStops[stop + 1] - kStops[stop]);
}

Vec3 classColour(foam::BubbleClass type) {
  static const Vec3 kOfClass[] = {{0.05f, 0.22f, 0.70f}, {0.06f, 0.48f, 0.16f}, {0.85f, 0.25f, 0.04f}};
  return kOfClass[static_cast<int>(type)];
}

Vec3 bubblePaint(const PreviewScene& scene, PreviewStyle style, int bubble) {
  if (style == PreviewStyle::classes) return classColour(scene.bubbleType[bubble]);
  return shadeColour(scene.bubbleShade.empty() ? 0 : static_cast<float>(scene.bubbleShade[bubble]));
}

}  // namespace spume::apps
