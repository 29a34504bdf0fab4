#pragma once

#include <memory>
#include <vector>

#include "apps/preview/bubble_cells.h"
#include "apps/preview/preview_scene.h"
#include "apps/preview/surface_mesh.h"

namespace spume::apps {

enum class SurfaceKind { none, water, bubble, solid };

/// The nearest surface along a ray; a drop counts as water.
struct SurfaceHit {
  SurfaceKind kind = SurfaceKind::none;
  int index = -1;         ///< of the bubble or solid
  float distance = 0;     ///< along the ray [m]
  Vec3 normal;            ///< unit, smooth: out of the water or solid; not set for bubbles
  bool entering = false;  ///< the ray goes into the water, bubble or solid
};

/// Water surface, bubbles and solids as a ray tracer's search structure (Embree). Thread-safe.
class RayScene {
 public:
  /// `cells` must outlive this object. Throws std::runtime_error if the tracing library cannot start.
  RayScene(const PreviewScene& scene, const BubbleCells& cells, SurfaceMesh water,
           std::vector<SurfaceMesh> solids);
  ~RayScene();
  RayScene(const RayScene&) = delete;
  RayScene& operator=(const RayScene&) = delete;

  float offset() const;  ///< shortest distance a ray sees [m]
  /// Nearest surface between that offset and `limit` [m]; bubbles only from outside them.
  SurfaceHit nearest(const Vec3& origin, const Vec3& direction, float limit) const;
  /// The same where solids are all there is.
  SurfaceHit nearestSolid(const Vec3& origin, const Vec3& direction, float limit) const;

 private:
  struct Internals;
  std::unique_ptr<Internals> internals_;
};

}  // namespace spume::apps
