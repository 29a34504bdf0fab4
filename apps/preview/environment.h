#pragma once

#include "apps/preview/caustics.h"
#include "apps/preview/preview_scene.h"

namespace spume::apps {

/// What surrounds the glass box: a pale table that fades into a soft backdrop, two windows and a large soft
/// light overhead. Everything is a closed formula of the ray, so that a ray that leaves the box costs no
/// search.
class Environment {
 public:
  Environment(const Vec3& lower, const Vec3& upper, CausticMap caustics);

  /// Linear RGB radiance seen from `origin` outside the box along the unit `direction`.
  Vec3 radiance(const Vec3& origin, const Vec3& direction) const;
  /// Radiance of the pale base under the water at `p` on the floor of the box.
  Vec3 base(const Vec3& p) const;
  /// Light a matte surface of normal `n` receives in the open, as radiance of a white one.
  static Vec3 ambient(const Vec3& n);

 private:
  Vec3 sky(const Vec3& direction) const;
  Vec3 table(const Vec3& p) const;

  Vec3 lower_, upper_, centre_;
  float size_;
  CausticMap caustics_;
};

}  // namespace spume::apps
