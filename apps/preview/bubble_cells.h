#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "apps/preview/preview_scene.h"

namespace spume::apps {

/// A surface with the rounding of a Plateau border.
struct Rounding {
  Vec3 normal;      ///< unit, turned towards the middle of the border
  float share = 0;  ///< 0 outside the border, 1 in its middle
};

/// How far a film leans over in its border, as tan of the angle.
inline constexpr float kFilmTurn = 0.8f;
/// Share of the rounding at `distance` from the middle of a border of `width`: 1 there, 0 at its edge.
inline float borderShare(float distance, float width) {
  const float x = 1 - std::max(distance, 0.0f) / width;
  return x * x * (3 - 2 * x);
}

/// Every bubble as the convex piece of its ball that the radical planes of its neighbours leave (model, "Foam
/// geometry"), cut also by the walls of the box and by solids it touches. Thread-safe.
class BubbleCells {
 public:
  static constexpr int kSkin = -1;  ///< the face that is the ball's own sphere
  static constexpr int kWall = -1;  ///< the neighbour behind the face of a wall or solid

  explicit BubbleCells(const PreviewScene& scene);

  int size() const { return static_cast<int>(centre_.size()); }
  const Vec3& centre(int bubble) const { return centre_[bubble]; }
  float radius(int bubble) const { return radius_[bubble]; }
  int firstFace(int bubble) const { return faceStart_[bubble]; }
  int endFace(int bubble) const { return faceStart_[bubble + 1]; }
  int neighbour(int face) const { return neighbour_[face]; }
  const Vec3& planeNormal(int face) const { return plane_[face].normal; }

  /// The stretch of a ray inside a cell [m], and the faces at its ends.
  struct Stretch {
    float in, out;
    int faceIn, faceOut;
  };
  /// Where the line `origin` + t `direction` (unit) runs in the cell; false if it misses. O(faces).
  bool cut(int bubble, const Vec3& origin, const Vec3& direction, Stretch& stretch) const;
  /// The same of the ball cut by walls alone: its films are somebody else's.
  bool cutByWalls(int bubble, const Vec3& origin, const Vec3& direction, Stretch& stretch) const;

  /// The other bubble whose ball reaches beyond this one's skin at `p`, by far enough to be no round-off; -1:
  /// none.
  int beyondSkin(int bubble, const Vec3& p) const;
  /// The face of a wall that `p` lies on, or kSkin.
  int wallAt(int bubble, const Vec3& p) const;
  bool holds(int bubble, const Vec3& p) const;

  /// Outward normal at `p` on the bubble's face, bent as the pressure of the two bubbles bends the film.
  Vec3 normalAt(int bubble, int face, const Vec3& p) const;
  /// The same with the rounding of a border of `width` [m] towards the nearest other face.
  Rounding roundedAt(int bubble, int face, const Vec3& p, float width) const;

 private:
  struct Plane {
    Vec3 normal;   ///< unit, out of the bubble
    float height;  ///< from the centre, > 0 towards the neighbour [m]
  };
  struct Face {
    Plane plane;
    std::int32_t neighbour;
    float curvature;  ///< of the film, > 0: bulges out of the bubble [1/m]
  };
  template <typename Counts>
  bool cutWhere(int bubble, const Vec3& origin, const Vec3& direction, const Counts& counts,
                Stretch& stretch) const;
  void neighbourFaces(const PreviewScene& scene, int bubble, const std::vector<std::int32_t>& candidates,
                      std::vector<Face>& faces);
  void wallFaces(const PreviewScene& scene, int bubble, std::vector<Face>& faces) const;
  void build(const PreviewScene& scene);

  std::vector<Vec3> centre_;
  std::vector<float> radius_;  ///< 0: swallowed by another ball
  std::vector<std::int32_t> faceStart_, neighbour_;
  std::vector<Plane> plane_;
  std::vector<float> curvature_;
};

}  // namespace spume::apps
