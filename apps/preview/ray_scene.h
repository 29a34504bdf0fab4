#pragma once

#include <memory>

#include "apps/preview/preview_scene.h"
#include "apps/preview/surface_mesh.h"

namespace spume::apps {

enum class SurfaceKind { none, water, bubble, solid, drop };

/// The nearest surface along a ray; a drop counts as water.
struct SurfaceHit {
  SurfaceKind kind = SurfaceKind::none;
  float distance = 0;     ///< along the ray [m]
  Vec3 normal;            ///< unit, smooth: out of the water, out of the bubble, out of the solid
  bool entering = false;  ///< the ray goes into the water, bubble or solid
  unsigned bubble = 0;    ///< index of the bubble
};

/// Water surface, bubbles and solids as a ray tracer's search structure (Embree). Thread-safe.
class RayScene {
 public:
  /// Throws std::runtime_error if the tracing library cannot start.
  RayScene(const PreviewScene& scene, SurfaceMesh water, SurfaceMesh solid);
  ~RayScene();
  RayScene(const RayScene&) = delete;
  RayScene& operator=(const RayScene&) = delete;

  /// Nearest surface between a small offset and `limit` [m].
  SurfaceHit nearest(const Vec3& origin, const Vec3& direction, float limit) const;

 private:
  struct Internals;
  std::unique_ptr<Internals> internals_;
};

}  // namespace spume::apps
