#include "apps/preview/environment.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace spume::apps {
namespace {

// Colours in linear RGB, chosen by eye: cool and dim enough that the edges of glass and bubbles stand out.
const Vec3 kHorizon{0.20f, 0.27f, 0.36f};
const Vec3 kZenith{0.03f, 0.05f, 0.09f};
const Vec3 kTable{0.22f, 0.265f, 0.32f};
const Vec3 kBase{0.55f, 0.66f, 0.70f};
const Vec3 kOverhead{5.0f, 4.9f, 4.7f};
const Vec3 kWindow{6.0f, 6.4f, 7.0f};

float smoothStep(float from, float to, float x) {
  const float t = std::clamp((x - from) / (to - from), 0.0f, 1.0f);
  return t * t * (3 - 2 * t);
}

/// 1 inside an upright window seen at `azimuth` [rad] between two slopes d.y, with soft edges; 0 elsewhere.
float window(const Vec3& d, float azimuth, float halfWidth, float low, float high) {
  constexpr float kSoft = 0.06f;
  const float offset = std::remainder(std::atan2(d.x(), d.z()) - azimuth, 2 * static_cast<float>(M_PI));
  return smoothStep(halfWidth + kSoft, halfWidth, std::abs(offset)) * smoothStep(low - kSoft, low, d.y()) *
         smoothStep(high + kSoft, high, d.y());
}

}  // namespace

Environment::Environment(const Vec3& lower, const Vec3& upper, CausticMap caustics)
    : lower_(lower),
      upper_(upper),
      centre_(0.5f * (lower + upper)),
      size_((upper - lower).maxCoeff()),
      caustics_(std::move(caustics)) {}

Vec3 Environment::sky(const Vec3& d) const {
  constexpr float kLeft = -1.05f,
                  kRight = 1.45f;  // azimuths of the windows, both outside an automatic camera's view [rad]
  Vec3 light = kHorizon + (kZenith - kHorizon) * smoothStep(-0.1f, 0.75f, d.y());
  light += kOverhead * smoothStep(0.86f, 0.94f, d.y());
  light += kWindow * window(d, kLeft, 0.22f, 0.12f, 0.62f);
  light += 0.7f * kWindow * window(d, kRight, 0.16f, 0.10f, 0.55f);
  return light;
}

Vec3 Environment::table(const Vec3& p) const {
  const float dx = std::max({lower_.x() - p.x(), 0.0f, p.x() - upper_.x()}) / size_;
  const float dz = std::max({lower_.z() - p.z(), 0.0f, p.z() - upper_.z()}) / size_;
  const float gap = std::sqrt(dx * dx + dz * dz);
  const float contact = 0.45f * std::exp(-gap / 0.035f), wide = 0.30f * std::exp(-gap / 0.25f);
  return kTable * ((1 - contact) * (1 - wide));
}

Vec3 Environment::radiance(const Vec3& origin, const Vec3& direction) const {
  if (direction.y() >= 0) return sky(direction);
  const float t = (lower_.y() - origin.y()) / direction.y();
  const Vec3 p = origin + std::max(t, 0.0f) * direction;
  const float distance = (p - centre_).norm() / size_;
  const float fade = smoothStep(1.0f, 4.5f, distance);
  return (1 - fade) * table(p) + fade * sky(Vec3(direction.x(), 0, direction.z()).normalized());
}

Vec3 Environment::base(const Vec3& p) const {
  constexpr float kDirect =
      0.55f;  // share of the base's light that comes from overhead and is focused by the water
  const float wall =
      std::min({p.x() - lower_.x(), upper_.x() - p.x(), p.z() - lower_.z(), upper_.z() - p.z()}) / size_;
  const float corner = 1 - 0.35f * std::exp(-std::max(wall, 0.0f) / 0.04f);
  return kBase * (corner * (1 - kDirect + kDirect * caustics_.at(p)));
}

Vec3 Environment::ambient(const Vec3& n) {
  const Vec3 key = Vec3(-0.45f, 0.80f, 0.40f);
  return Vec3(0.32f, 0.36f, 0.42f) * (0.75f + 0.25f * n.y()) +
         Vec3(0.62f, 0.60f, 0.56f) * std::max(0.0f, n.dot(key));
}

}  // namespace spume::apps
