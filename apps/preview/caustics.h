#pragma once

#include <vector>

#include "apps/preview/preview_scene.h"
#include "apps/preview/ray_scene.h"

namespace spume::apps {

/// Light that falls straight down and is focused by the water on the floor of the box, relative to the light
/// without water: 1 on average where nothing shades the floor.
class CausticMap {
 public:
  CausticMap() = default;
  /// Follows a fixed lattice of rays from above through the first water surface, darkened by bubbles and
  /// solids.
  CausticMap(const RayScene& rays, const Vec3& lower, const Vec3& upper);
  /// Relative light at `p` on the floor, bilinear; 1 for an empty map.
  float at(const Vec3& p) const;

 private:
  void blur();
  float& cell(int i, int k) { return light_[static_cast<std::size_t>(i) * kSide + k]; }
  float cell(int i, int k) const { return light_[static_cast<std::size_t>(i) * kSide + k]; }

  static constexpr int kSide = 96;  ///< texels along x and z
  Vec3 lower_ = Vec3::Zero(), size_ = Vec3::Ones();
  std::vector<float> light_;
};

}  // namespace spume::apps
