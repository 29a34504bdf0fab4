#pragma once

#include "apps/preview/bubble_cells.h"
#include "apps/preview/film_surfaces.h"
#include "apps/preview/glass_box.h"
#include "apps/preview/ray_scene.h"

namespace spume::apps {

enum class Place { outside, glass, inside };  ///< of the box

/// A ray of light and what it is inside of.
struct LightPath {
  Vec3 origin, direction;  ///< [m], unit
  Place place = Place::outside;
  bool inWater = false;
  int solid = -1;   ///< of glass; -1: none
  int bubble = -1;  ///< -1: none
};

enum class Boundary { surroundings, table, matte, clear };

/// What a path meets next.
struct Crossing {
  Boundary kind = Boundary::surroundings;
  Vec3 normal = Vec3::UnitY();   ///< unit, against the path
  Vec3 passed = Vec3::Ones();    ///< share of the light left on the way here
  Vec3 mirrored = Vec3::Zero();  ///< share of that the boundary mirrors
  float border = 0;              ///< 0 outside a Plateau border, 1 in its middle
  float scattered = 0;           ///< share a Plateau border spreads to all sides
  int bubble = -1;               ///< the bubble whose skin or film this is
  LightPath behind;              ///< the path past the boundary, where not all is mirrored
  bool passes() const { return mirrored.minCoeff() < 1; }
};

/// Absorption [1/m] that leaves the share `left` of light after `depth` [m].
Vec3 absorptionOf(const Vec3& left, float depth);
/// Share of light left after `distance` [m] [Beer-Lambert].
Vec3 passedShare(const Vec3& absorption, float distance);

/// How light goes through panes, water, solids of glass and bubbles. Knows no lamps and gathers nothing.
/// Thread-safe.
class Optics {
 public:
  /// All arguments must outlive this object; `films` null: cells are cut by their planes. A `diagram` bends
  /// no light at flat boundaries, so that things are seen where they are.
  Optics(const PreviewScene& scene, const GlassBox& box, const BubbleCells& cells, const FilmSurfaces* films,
         const RayScene& rays, bool diagram);

  /// Moves the path to the next boundary and describes it.
  Crossing next(LightPath& path) const;
  /// A path outside all bubbles and solids, from wherever it starts.
  LightPath startAt(const Vec3& origin, const Vec3& direction) const;

 private:
  /// A point of a bubble's surface, normals against the path.
  struct Face {
    Vec3 normal, exact;  ///< with and without the rounding of a Plateau border
    float share;         ///< of that rounding, 0..1
  };
  Crossing nextOutside(LightPath& path) const;
  Crossing nextInGlass(LightPath& path) const;
  Crossing nextInside(LightPath& path) const;
  Crossing nextInBubble(LightPath& path) const;
  /// Moves the path to where it leaves its bubble; sets the bubble behind, -1: none.
  Face leaveByPlanes(LightPath& path, int& other) const;
  Face leaveByFilms(LightPath& path, int& other) const;
  int bubbleBehindSkin(const LightPath& path, int bubble) const;
  Crossing leaveInside(LightPath& path, const GlassBox::Hit& wall, Crossing crossing) const;
  void meetSurface(const LightPath& path, const SurfaceHit& hit, Crossing& crossing) const;
  void meetSkin(const LightPath& path, int bubble, Crossing& crossing) const;
  void refractOrMirror(const LightPath& path, Crossing& crossing) const;
  Face faceAt(const LightPath& path, int bubble, int face) const;
  Face wallFace(const LightPath& path, int bubble, int face) const;
  float borderOf(int bubble) const;
  void crossFilm(const LightPath& path, const Face& film, int other, Crossing& crossing) const;
  float filmThickness(int bubble, int other, const Vec3& p) const;
  float indexOf(const LightPath& path) const;
  bool liquidAt(const Vec3& p) const;
  void settle(LightPath& path) const;

  const PreviewScene& scene_;
  const GlassBox& box_;
  const BubbleCells& cells_;
  const FilmSurfaces* films_;
  const RayScene& rays_;
  bool diagram_;
  Vec3 waterAbsorption_, glassAbsorption_;  ///< [1/m]
};

}  // namespace spume::apps
