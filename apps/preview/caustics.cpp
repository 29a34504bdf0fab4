#include "apps/preview/caustics.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "apps/preview/fresnel.h"
#include "fluid/parallel.h"

namespace spume::apps {
namespace {

/// Where a ray that falls from above lands on the floor, and how much of its light is left.
struct Landing {
  float x = 0, z = 0, light = 0;
};

Landing follow(const RayScene& rays, Vec3 origin, float floor) {
  constexpr float kThroughBubble = 0.55f;  // light a bubble scatters aside, by eye
  constexpr int kMaxHits = 12;
  Vec3 direction =
      Vec3(0.06f, -1, -0.04f).normalized();  // slightly off vertical, so that the box casts no grid
  float light = 1;
  bool inWater = false;
  for (int n = 0; n < kMaxHits; ++n) {
    const float toFloor = (floor - origin.y()) / direction.y();
    const SurfaceHit hit = rays.nearest(origin, direction, toFloor);
    if (hit.kind == SurfaceKind::none)
      return {origin.x() + toFloor * direction.x(), origin.z() + toFloor * direction.z(), light};
    if (hit.kind == SurfaceKind::solid) return {};
    if (hit.kind == SurfaceKind::bubble && hit.entering) light *= kThroughBubble;
    origin += hit.distance * direction;
    if (hit.kind != SurfaceKind::water || hit.entering == inWater) continue;
    const Vec3 n0 = hit.entering ? hit.normal : Vec3(-hit.normal);
    const float eta = hit.entering ? kWaterIndex : 1 / kWaterIndex;
    const float cosIn = -direction.dot(n0);
    if (cosIn <= 0 || fresnelReflectance(cosIn, eta) == 1 || direction.y() > -0.2f) return {};
    light *= 1 - fresnelReflectance(cosIn, eta);
    direction = refract(direction, n0, eta);
    inWater = hit.entering;
  }
  return {};
}

}  // namespace

CausticMap::CausticMap(const RayScene& rays, const Vec3& lower, const Vec3& upper)
    : lower_(lower), size_(upper - lower), light_(kSide * kSide, 0.0f) {
  constexpr int kPerTexel = 2;
  const int side = kSide * kPerTexel;
  std::vector<Landing> landings(static_cast<std::size_t>(side) * side);
  tbb::parallel_for(0, side, [&](int i) {
    for (int k = 0; k < side; ++k) {
      const Vec3 start = lower + size_.cwiseProduct(Vec3((i + 0.5f) / side, 1, (k + 0.5f) / side));
      landings[static_cast<std::size_t>(i) * side + k] = follow(rays, start, lower.y());
    }
  });
  for (const Landing& landing : landings) {
    const int i = std::clamp(static_cast<int>((landing.x - lower.x()) / size_.x() * kSide), 0, kSide - 1);
    const int k = std::clamp(static_cast<int>((landing.z - lower.z()) / size_.z() * kSide), 0, kSide - 1);
    cell(i, k) += landing.light / (kPerTexel * kPerTexel);
  }
  blur();
}

void CausticMap::blur() {
  const std::vector<float> sharp = light_;
  const auto at = [&](int i, int k) {
    return sharp[static_cast<std::size_t>(std::clamp(i, 0, kSide - 1)) * kSide + std::clamp(k, 0, kSide - 1)];
  };
  for (int i = 0; i < kSide; ++i)
    for (int k = 0; k < kSide; ++k) {
      float sum = 0;
      for (int a = -1; a <= 1; ++a)
        for (int b = -1; b <= 1; ++b) sum += (2 - std::abs(a)) * (2 - std::abs(b)) * at(i + a, k + b);
      cell(i, k) = std::min(sum / 16, 3.0f);
    }
}

float CausticMap::at(const Vec3& p) const {
  if (light_.empty()) return 1;
  const float x = std::clamp((p.x() - lower_.x()) / size_.x() * kSide - 0.5f, 0.0f, kSide - 1.001f);
  const float z = std::clamp((p.z() - lower_.z()) / size_.z() * kSide - 0.5f, 0.0f, kSide - 1.001f);
  const int i = static_cast<int>(x), k = static_cast<int>(z);
  const float fx = x - i, fz = z - k;
  return (1 - fx) * ((1 - fz) * cell(i, k) + fz * cell(i, k + 1)) +
         fx * ((1 - fz) * cell(i + 1, k) + fz * cell(i + 1, k + 1));
}

}  // namespace spume::apps
