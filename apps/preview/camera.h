#pragma once

#include "apps/preview/preview_scene.h"

namespace spume::apps {

/// A pinhole camera.
class Camera {
 public:
  /// `box` of the scene decides the place of an automatic camera: from the front, a little to the left and
  /// above.
  Camera(const PreviewScene& scene, int width, int height);

  const Vec3& eye() const { return eye_; }
  /// Unit direction through the picture point (x, y) [pixels], from the top left corner.
  Vec3 direction(float x, float y) const;

 private:
  void placeBefore(const PreviewScene& scene, float aspect);

  Vec3 eye_, target_, right_, up_, forward_;
  float tangent_;         ///< of half the vertical field of view
  float width_, height_;  ///< [pixels]
};

}  // namespace spume::apps
