#pragma once

#include "apps/preview/preview_scene.h"

namespace spume::apps {

/// A pinhole camera.
class Camera {
 public:
  /// An automatic camera stands in front, a little to the left and above, and shows all of `shown` [m].
  Camera(const coupling::CameraSpec& spec, const Eigen::AlignedBox3f& shown, int width, int height);

  const Vec3& eye() const { return eye_; }
  /// Unit direction through the picture point (x, y) [pixels], from the top left corner.
  Vec3 direction(float x, float y) const;

 private:
  void placeBefore(const Eigen::AlignedBox3f& shown, float aspect);

  Vec3 eye_, target_, right_, up_, forward_;
  float tangent_;         ///< of half the vertical field of view
  float width_, height_;  ///< [pixels]
};

}  // namespace spume::apps
