#include "apps/preview/light_map.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "apps/preview/fresnel.h"
#include "apps/preview/optics.h"

namespace spume::apps {
namespace {

struct Landing {
  float x = 0, z = 0;
  Vec3 light = Vec3::Zero();
};

/// Follows the stronger branch at every boundary to the table, or until the light is lost.
Landing follow(const Optics& optics, LightPath path, float table) {
  constexpr int kMostBoundaries = 60;
  constexpr float kLost = 0.01f;
  Vec3 light = Vec3::Ones();
  for (int n = 0; n < kMostBoundaries; ++n) {
    const Crossing crossing = optics.next(path);
    light = light.cwiseProduct(crossing.passed);
    if (crossing.kind == Boundary::matte) return {};
    if (crossing.kind == Boundary::surroundings) {
      if (path.direction.y() >= 0) return {};
      path.origin += (table - path.origin.y()) / path.direction.y() * path.direction;
    }
    if (crossing.kind != Boundary::clear) return {path.origin.x(), path.origin.z(), light};
    if (crossing.passes()) {
      light = light.cwiseProduct(Vec3::Ones() - crossing.mirrored) * (1 - crossing.scattered);
      path = crossing.behind;
    } else {
      path.direction = reflect(path.direction, crossing.normal);
    }
    if (light.maxCoeff() < kLost) return {};
  }
  return {};
}

/// Unit direction number n of `count` spread evenly over a disc around `middle`.
Vec3 discDirection(const Vec3& middle, int n, int count) {
  constexpr float kRadius = 0.16f;  // of the light, as tan of the angle: the softness of shadows
  constexpr float kGoldenAngle = 2.3999632f;
  const Vec3 right = middle.cross(Vec3::UnitY()).normalized(), up = right.cross(middle);
  const float r = kRadius * std::sqrt((n + 0.5f) / count), angle = kGoldenAngle * n;
  return (middle + r * (std::cos(angle) * right + std::sin(angle) * up)).normalized();
}

}  // namespace

LightMap::LightMap(const Optics& optics, const GlassBox& box, const Vec3& towards, int detail) {
  constexpr float kReach = 1.1f;                // of the map beyond the box, in boxes
  constexpr int kTexels = 96, kDirections = 5;  // times detail
  side_ = kTexels * detail;
  edge_ = (1 + 2 * kReach) * box.size();
  const Vec3 middle = 0.5f * (box.lower() + box.upper());
  x_ = middle.x() - 0.5f * edge_, z_ = middle.z() - 0.5f * edge_;
  light_.assign(static_cast<std::size_t>(side_) * side_, Vec3::Zero());
  const float table = box.tableHeight(), far = 4 * box.size();
  const int directions = kDirections * detail;
  std::vector<Landing> landings(light_.size());
  for (int d = 0; d < directions; ++d) {
    const Vec3 up = discDirection(towards, d, directions);
    const float shiftX = std::fmod(0.5f + 0.618034f * d, 1.0f),
                shiftZ = std::fmod(0.5f + 0.754878f * d, 1.0f);
    tbb::parallel_for(0, side_, [&](int i) {
      for (int k = 0; k < side_; ++k) {
        const Vec3 spot(x_ + (i + shiftX) / side_ * edge_, table, z_ + (k + shiftZ) / side_ * edge_);
        landings[static_cast<std::size_t>(i) * side_ + k] =
            follow(optics, LightPath{spot + far * up, -up}, table);
      }
    });
    for (const Landing& landing : landings) splat(landing.x, landing.z, landing.light / directions);
  }
  blur();
}

/// Shares light among the four texels around a point.
void LightMap::splat(float x, float z, const Vec3& light) {
  const float u = (x - x_) / edge_ * side_ - 0.5f, v = (z - z_) / edge_ * side_ - 0.5f;
  const int i = static_cast<int>(std::floor(u)), k = static_cast<int>(std::floor(v));
  const float fu = u - i, fv = v - k;
  for (int n = 0; n < 4; ++n) {
    const int a = i + (n & 1), b = k + (n >> 1);
    if (a < 0 || b < 0 || a >= side_ || b >= side_) continue;
    texel(a, b) += (n & 1 ? fu : 1 - fu) * (n >> 1 ? fv : 1 - fv) * light;
  }
}

/// A 3 x 3 tent: hides the lattice of the rays.
void LightMap::blur() {
  const std::vector<Vec3> sharp = light_;
  for (int i = 0; i < side_; ++i)
    for (int k = 0; k < side_; ++k) {
      Vec3 sum = Vec3::Zero();
      for (int a = -1; a <= 1; ++a)
        for (int b = -1; b <= 1; ++b)
          sum += static_cast<float>((2 - std::abs(a)) * (2 - std::abs(b))) *
                 sharp[static_cast<std::size_t>(std::clamp(i + a, 0, side_ - 1)) * side_ +
                       std::clamp(k + b, 0, side_ - 1)];
      texel(i, k) = sum / 16;
    }
}

Vec3 LightMap::at(const Vec3& p) const {
  if (light_.empty()) return Vec3::Ones();
  const float u = (p.x() - x_) / edge_ * side_ - 0.5f, v = (p.z() - z_) / edge_ * side_ - 0.5f;
  const int i = static_cast<int>(std::floor(u)), k = static_cast<int>(std::floor(v));
  if (i < 1 || k < 1 || i >= side_ - 2 || k >= side_ - 2) return Vec3::Ones();
  const float fu = u - i, fv = v - k;
  return (1 - fu) * ((1 - fv) * texel(i, k) + fv * texel(i, k + 1)) +
         fu * ((1 - fv) * texel(i + 1, k) + fv * texel(i + 1, k + 1));
}

}  // namespace spume::apps
