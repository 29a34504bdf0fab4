#include "apps/preview/environment.h"

#include <algorithm>
#include <cmath>

namespace spume::apps {
namespace {

// Colours in linear RGB, chosen by eye so that edges of glass and bubbles stand out.
const Vec3 kTableColour{0.335f, 0.335f, 0.34f};
const Vec3 kHorizon{0.40f, 0.44f, 0.49f};
const Vec3 kZenith{0.065f, 0.085f, 0.12f};
const Vec3 kKeyLight{9.0f, 8.7f, 8.2f};
const Vec3 kStripLight{4.2f, 4.5f, 4.8f};
const Vec3 kBackLight{2.6f, 2.8f, 3.0f};
constexpr float kDarkTable = 0.10f, kDarkSky = 0.05f;  // of the dark backdrop, times the light one
constexpr float kAmbientShare =
    0.42f;  // of the table's light that no object shades, because it comes from all sides

float smoothStep(float from, float to, float x) {
  const float t = std::clamp((x - from) / (to - from), 0.0f, 1.0f);
  return t * t * (3 - 2 * t);
}

/// A flat lamp far away: a rectangle across `direction` whose edges are soft.
struct Lamp {
  Vec3 direction, right, up;
  float halfWidth, halfHeight;  ///< tangents of the angles they are seen under

  Lamp(const Vec3& towards, float width, float height)
      : direction(towards.normalized()),
        right(direction.cross(Vec3::UnitY()).normalized()),
        up(right.cross(direction)),
        halfWidth(width),
        halfHeight(height) {}
  /// 1 in the lamp, 0 outside.
  float at(const Vec3& d) const {
    constexpr float kSoft = 0.05f;
    const float ahead = d.dot(direction);
    if (ahead <= 0.1f) return 0;
    const float u = std::abs(d.dot(right)) / ahead, v = std::abs(d.dot(up)) / ahead;
    return smoothStep(halfWidth + kSoft, halfWidth - kSoft, u) *
           smoothStep(halfHeight + kSoft, halfHeight - kSoft, v);
  }
};

// Where the lamps stand, none in view of an automatic camera.
const Lamp kKey({-0.55f, 0.75f, 0.42f}, 0.40f, 0.30f);
const Lamp kStrip({0.93f, 0.30f, 0.30f}, 0.09f, 0.50f);
const Lamp kBack({-0.80f, 0.42f, -0.42f}, 0.16f, 0.34f);

}  // namespace

Environment::Environment(const GlassBox& box, coupling::Backdrop backdrop)
    : centre_(0.5f * (box.lower() + box.upper())),
      tableHeight_(box.tableHeight()),
      size_(box.size()),
      dark_(backdrop == coupling::Backdrop::dark) {}

Vec3 Environment::keyDirection() { return kKey.direction; }

/// The backdrop is brightest behind the scene, low; the room behind the camera is dim.
Vec3 Environment::sky(const Vec3& d) const {
  constexpr float kGlow = 0.75f, kRoom = 0.35f;
  Vec3 light = kHorizon + (kZenith - kHorizon) * smoothStep(-0.05f, 0.85f, d.y());
  const float behind = (d - Vec3(0.25f, 0.1f, -0.96f)).squaredNorm();
  light *= (1 + kGlow * std::exp(-behind / 0.3f)) * (1 - (1 - kRoom) * smoothStep(-0.3f, 0.5f, d.z()));
  if (dark_) light *= kDarkSky;
  return light + kKeyLight * kKey.at(d) + kStripLight * kStrip.at(d) + kBackLight * kBack.at(d);
}

Vec3 Environment::table(const Vec3& p) const {
  const Vec3 colour = dark_ ? Vec3(kTableColour * kDarkTable) : kTableColour;
  return colour.cwiseProduct(Vec3::Constant(kAmbientShare) + (1 - kAmbientShare) * lightMap_.at(p));
}

Vec3 Environment::radiance(const Vec3& origin, const Vec3& direction) const {
  constexpr float kNear = 0.8f, kFar = 4.5f;  // where the table fades into the backdrop, in boxes
  if (direction.y() >= 0) return sky(direction);
  const float t = (tableHeight_ - origin.y()) / direction.y();
  const Vec3 p = origin + std::max(t, 0.0f) * direction;
  const float fade = smoothStep(kNear, kFar, (p - centre_).norm() / size_);
  if (fade >= 1) return sky(Vec3(direction.x(), 0, direction.z()).normalized());
  return (1 - fade) * table(p) + fade * sky(Vec3(direction.x(), 0, direction.z()).normalized());
}

Vec3 Environment::ambient(const Vec3& n) const {
  const Vec3 all = Vec3(0.44f, 0.46f, 0.50f) * (0.7f + 0.3f * n.y());
  const Vec3 key = Vec3(0.62f, 0.60f, 0.56f) * std::max(0.0f, n.dot(kKey.direction));
  return dark_ ? Vec3(0.25f * all + key) : Vec3(all + key);
}

}  // namespace spume::apps
