#pragma once

#include <array>

#include "apps/preview/preview_scene.h"

namespace spume::apps {

/// The box of the domain with panes of glass outside its closed walls. It stands on the table.
class GlassBox {
 public:
  explicit GlassBox(const PreviewScene& scene);

  /// Where a ray meets the next boundary of the box.
  struct Hit {
    float distance = 0;  ///< [m], >= 0
    int face = -1;       ///< -x +x -y +y -z +z; -1: none
    bool inner = false;  ///< the boundary between glass, or an opening, and the inside
  };
  Hit fromOutside(const Vec3& origin, const Vec3& direction) const;
  Hit fromGlass(const Vec3& origin, const Vec3& direction) const;
  Hit fromInside(const Vec3& origin, const Vec3& direction) const;

  bool isDrawn() const { return inner_ != outer_; }
  bool isPane(int face) const { return pane_[face]; }
  /// Height of the table under the box [m].
  float tableHeight() const { return outer_[0].y(); }
  const Vec3& lower() const { return inner_[0]; }
  const Vec3& upper() const { return inner_[1]; }
  const Vec3& outerLower() const { return outer_[0]; }
  const Vec3& outerUpper() const { return outer_[1]; }
  float size() const { return (inner_[1] - inner_[0]).maxCoeff(); }
  static Vec3 outward(int face) { return (face % 2 ? 1.0f : -1.0f) * Vec3::Unit(face / 2); }

 private:
  std::array<Vec3, 2> inner_, outer_;  ///< low and high corners [m]
  std::array<bool, 6> pane_{};
};

}  // namespace spume::apps
