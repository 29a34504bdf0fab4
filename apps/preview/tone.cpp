#include "apps/preview/tone.h"

#include <algorithm>
#include <cmath>

namespace spume::apps {

Vec3 toDisplay(const Vec3& light) {
  constexpr float kExposure = 0.72f;
  return light.unaryExpr([](float radiance) {
    const float x = std::max(radiance, 0.0f) * kExposure;
    const float linear = std::min(x * (2.4f * x + 0.05f) / (x * (2.4f * x + 0.72f) + 0.13f), 1.0f);
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
  });
}

}  // namespace spume::apps
