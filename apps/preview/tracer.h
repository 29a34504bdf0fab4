#pragma once

#include <array>

#include "apps/preview/environment.h"
#include "apps/preview/ray_scene.h"

namespace spume::apps {

/// Light along camera rays through the glass box: panes, water, bubbles and solids. Thread-safe, no random
/// numbers.
class Tracer {
 public:
  Tracer(const PreviewScene& scene, PreviewStyle style, const RayScene& rays, const Environment& environment);

  /// Linear RGB radiance that arrives at `origin` against the unit `direction`.
  Vec3 radiance(const Vec3& origin, const Vec3& direction) const;

 private:
  /// A piece of a light path: where it goes, what it carries and what it is inside of.
  struct Path {
    Vec3 origin, direction, weight;
    bool inBox = false, inWater = false;
    int bubbles = 0;  ///< balls the path is inside of
    int depth = 0;    ///< interfaces met so far
  };
  /// Work of one camera ray: pending branches and the light gathered.
  struct Work {
    static constexpr int kCapacity = 24;
    std::array<Path, kCapacity> pending;
    int count = 0;
    Vec3 light = Vec3::Zero();
  };

  void advance(Path path, Work& work) const;
  void enterBox(Path& path, Work& work) const;
  void leaveBox(Path& path, int face, Work& work) const;
  void meetSurface(const Path& path, const SurfaceHit& hit, Work& work) const;
  void meetBubble(const Path& path, const SurfaceHit& hit, Work& work) const;
  /// A boundary that mirrors `share` of the light: `front` and `behind` are the path's states on its two
  /// sides.
  void split(const Path& front, Path behind, const Vec3& normal, const Vec3& share, float eta,
             Work& work) const;
  void mirror(const Path& path, const Vec3& normal, const Vec3& share, Work& work) const;
  void push(const Path& path, Work& work) const;
  Vec3 paneEdge(const Vec3& p, int face) const;
  bool liquidAt(const Vec3& p) const;
  float wallDistance(const Path& path, int& face) const;

  const PreviewScene& scene_;
  PreviewStyle style_;
  const RayScene& rays_;
  const Environment& environment_;
  Vec3 lower_, upper_, absorption_;
  float size_;
};

}  // namespace spume::apps
