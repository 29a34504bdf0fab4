#pragma once

#include <array>

#include "apps/preview/environment.h"
#include "apps/preview/optics.h"

namespace spume::apps {

/// Light along camera rays: follows every branch that matters through the scene, gathers from the
/// surroundings. Thread-safe, no random numbers.
class Tracer {
 public:
  Tracer(const PreviewScene& scene, PreviewStyle style, const Optics& optics, const Environment& environment);

  /// Linear RGB radiance that arrives at `origin` against the unit `direction`.
  Vec3 radiance(const Vec3& origin, const Vec3& direction) const;

 private:
  struct Branch {
    LightPath path;
    Vec3 weight;
    int depth = 0;  ///< boundaries met so far
  };
  /// Work of one camera ray: pending branches and the light gathered.
  struct Work {
    static constexpr int kCapacity = 24;
    std::array<Branch, kCapacity> pending;
    int count = 0;
    Vec3 light = Vec3::Zero();
  };

  void advance(Branch branch, Work& work) const;
  void meet(const Branch& branch, const Crossing& crossing, Work& work) const;
  void mirror(const Branch& branch, const Crossing& crossing, Work& work) const;
  void push(const Branch& branch, Work& work) const;

  const PreviewScene& scene_;
  PreviewStyle style_;
  const Optics& optics_;
  const Environment& environment_;
  Vec3 borderTint_;
};

}  // namespace spume::apps
