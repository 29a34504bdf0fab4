#include "apps/preview/glass_box.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace spume::apps {
namespace {

/// Where a line is inside a box, and the faces it enters and leaves through.
struct Slab {
  float in = -std::numeric_limits<float>::max(), out = std::numeric_limits<float>::max();
  int faceIn = -1, faceOut = -1;
};

Slab clip(const std::array<Vec3, 2>& box, const Vec3& origin, const Vec3& direction) {
  Slab slab;
  for (int a = 0; a < 3; ++a) {
    const bool up = direction[a] >= 0;
    const float inverse = 1 / (up ? std::abs(direction[a]) : direction[a]);  // -0 must give +infinity
    const float in = (box[up ? 0 : 1][a] - origin[a]) * inverse;
    const float out = (box[up ? 1 : 0][a] - origin[a]) * inverse;
    if (in > slab.in) slab.in = in, slab.faceIn = 2 * a + !up;
    if (out < slab.out) slab.out = out, slab.faceOut = 2 * a + up;
  }
  return slab;
}

}  // namespace

GlassBox::GlassBox(const PreviewScene& scene)
    : inner_{scene.lower.cast<float>(), scene.upper.cast<float>()}, outer_(inner_) {
  constexpr float kThickness = 1.0f / 40;  // of the longest edge, unless the scene says more
  if (scene.look.box == coupling::BoxLook::none) return;
  const auto wanted = static_cast<float>(scene.look.glassThickness);
  const float thickness = wanted > 0 ? wanted : kThickness * size();
  for (int face = 0; face < 6; ++face) {
    pane_[face] = scene.closed[face];
    if (pane_[face]) outer_[face % 2] += thickness * outward(face);
  }
}

GlassBox::Hit GlassBox::fromOutside(const Vec3& origin, const Vec3& direction) const {
  const Slab slab = clip(outer_, origin, direction);
  if (slab.in >= slab.out || slab.in <= 0) return {};
  if (isPane(slab.faceIn)) return {slab.in, slab.faceIn, false};
  const Vec3 p = origin + slab.in * direction;
  bool opening = true;  // or the rim of a neighbouring pane
  for (int a = 0; a < 3; ++a)
    if (a != slab.faceIn / 2) opening = opening && p[a] > inner_[0][a] && p[a] < inner_[1][a];
  return {slab.in, slab.faceIn, opening};
}

GlassBox::Hit GlassBox::fromGlass(const Vec3& origin, const Vec3& direction) const {
  constexpr float kAhead = 1e-6f;  // of the box: nearer than rounding is where the ray comes from
  const Slab in = clip(inner_, origin, direction), out = clip(outer_, origin, direction);
  if (in.in < in.out && in.in > kAhead * size() && in.in < out.out) return {in.in, in.faceIn, true};
  return {std::max(out.out, 0.0f), out.faceOut, false};
}

GlassBox::Hit GlassBox::fromInside(const Vec3& origin, const Vec3& direction) const {
  const Slab slab = clip(inner_, origin, direction);
  return {std::max(slab.out, 0.0f), slab.faceOut, true};
}

}  // namespace spume::apps
