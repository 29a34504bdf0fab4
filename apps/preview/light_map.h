#pragma once

#include <vector>

#include "apps/preview/preview_scene.h"

namespace spume::apps {

class Optics;
class GlassBox;

/// Light of the key light on the table, relative to an empty one: shadows, and what water, glass and bubbles
/// focus.
class LightMap {
 public:
  LightMap() = default;
  /// Follows a fixed lattice of rays from a round light around `towards` (unit) to the table. `detail` 1 is
  /// for a quick look, 2 for a good one; the work grows with its cube.
  LightMap(const Optics& optics, const GlassBox& box, const Vec3& towards, int detail);
  /// Relative light at `p` on the table, bilinear; 1 outside the map.
  Vec3 at(const Vec3& p) const;

 private:
  void blur();
  Vec3& texel(int i, int k) { return light_[static_cast<std::size_t>(i) * side_ + k]; }
  const Vec3& texel(int i, int k) const { return light_[static_cast<std::size_t>(i) * side_ + k]; }
  void splat(float x, float z, const Vec3& light);

  int side_ = 0;         ///< texels along x and z
  float x_ = 0, z_ = 0;  ///< low corner [m]
  float edge_ = 1;       ///< of the map [m]
  std::vector<Vec3> light_;
};

}  // namespace spume::apps
