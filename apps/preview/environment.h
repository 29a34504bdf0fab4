#pragma once

#include "apps/preview/glass_box.h"
#include "apps/preview/light_map.h"
#include "apps/preview/preview_scene.h"

namespace spume::apps {

/// What surrounds the scene, as in a photographer's studio: a matte table that fades into a backdrop, a large
/// soft key light, a strip on the other side and a lamp behind. Everything is a closed formula of the ray, so
/// that a ray that leaves the scene costs no search.
class Environment {
 public:
  Environment(const GlassBox& box, coupling::Backdrop backdrop);

  /// Light of the key light on the table; 1 everywhere until this is called.
  void setLightMap(LightMap map) { lightMap_ = std::move(map); }
  /// Linear RGB radiance seen from `origin` outside the box along the unit `direction`.
  Vec3 radiance(const Vec3& origin, const Vec3& direction) const;
  /// Radiance of the table at `p`.
  Vec3 table(const Vec3& p) const;
  /// Light a matte surface of normal `n` receives in the open, as radiance of a white one.
  Vec3 ambient(const Vec3& n) const;
  /// Unit direction towards the middle of the key light.
  static Vec3 keyDirection();

 private:
  Vec3 sky(const Vec3& direction) const;

  Vec3 centre_;
  float tableHeight_, size_;
  bool dark_;
  LightMap lightMap_;
};

}  // namespace spume::apps
