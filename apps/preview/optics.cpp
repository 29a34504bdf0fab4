#include "apps/preview/optics.h"

#include <algorithm>
#include <cmath>

#include "apps/preview/film_thickness.h"
#include "apps/preview/fresnel.h"
#include "apps/preview/thin_film.h"

namespace spume::apps {
namespace {

/// What is left of white light after the length of the box in glass: the green of a pane's edge.
const Vec3 kThroughGlass{0.45f, 0.74f, 0.62f};
constexpr float kBorderScatter = 0.45f;  // of the light that meets the middle of a Plateau border, by eye
constexpr float kHaze = 0.02f;  // of the light that meets a film, scattered by what it carries, by eye
constexpr float kDiagramMirror = 0.10f;  // largest share a boundary of a diagram mirrors

Vec3 against(const Vec3& normal, const Vec3& direction) {
  return normal.dot(direction) < 0 ? normal : Vec3(-normal);
}

/// `rounded` where it faces the path, else the true normal: a rounding must not turn a surface over.
Vec3 facing(const Vec3& rounded, const Vec3& exact, const Vec3& direction) {
  constexpr float kGrazing = -1e-3f;
  return rounded.dot(direction) < kGrazing ? rounded : exact;
}

}  // namespace

Vec3 absorptionOf(const Vec3& left, float depth) { return -left.array().log() / depth; }

Vec3 passedShare(const Vec3& absorption, float distance) { return (-absorption * distance).array().exp(); }

Optics::Optics(const PreviewScene& scene, const GlassBox& box, const BubbleCells& cells,
               const FilmSurfaces* films, const RayScene& rays, bool diagram)
    : scene_(scene),
      box_(box),
      cells_(cells),
      films_(films),
      rays_(rays),
      diagram_(diagram),
      waterAbsorption_(
          absorptionOf(scene.look.liquidColour.cast<float>(), static_cast<float>(scene.look.colourDepth))),
      glassAbsorption_(absorptionOf(kThroughGlass, box.size())) {}

LightPath Optics::startAt(const Vec3& origin, const Vec3& direction) const {
  LightPath path{origin, direction};
  const auto isIn = [&](const Vec3& low, const Vec3& high) {
    return (origin.array() > low.array()).all() && (origin.array() < high.array()).all();
  };
  if (isIn(box_.outerLower(), box_.outerUpper())) path.place = Place::glass;
  if (!isIn(box_.lower(), box_.upper())) return path;
  path.place = Place::inside;
  settle(path);
  return path;
}

Crossing Optics::next(LightPath& path) const {
  if (path.bubble >= 0) return nextInBubble(path);
  if (path.place == Place::outside) return nextOutside(path);
  return path.place == Place::glass ? nextInGlass(path) : nextInside(path);
}

Crossing Optics::nextOutside(LightPath& path) const {
  const GlassBox::Hit hit = box_.fromOutside(path.origin, path.direction);
  if (hit.face < 0) return {};
  path.origin += hit.distance * path.direction;
  Crossing crossing{.kind = Boundary::clear, .normal = GlassBox::outward(hit.face), .behind = path};
  crossing.behind.place = hit.inner ? Place::inside : Place::glass;
  if (hit.inner) settle(crossing.behind);
  refractOrMirror(path, crossing);
  return crossing;
}

Crossing Optics::nextInGlass(LightPath& path) const {
  const GlassBox::Hit hit = box_.fromGlass(path.origin, path.direction);
  path.origin += hit.distance * path.direction;
  const bool down = !hit.inner && hit.face == 2;
  Crossing crossing{.kind = down ? Boundary::table : Boundary::clear,
                    .normal = against(GlassBox::outward(hit.face), path.direction),
                    .passed = passedShare(glassAbsorption_, hit.distance),
                    .behind = path};
  crossing.behind.place = hit.inner ? Place::inside : Place::outside;
  if (hit.inner) settle(crossing.behind);
  if (!down) refractOrMirror(path, crossing);
  return crossing;
}

Crossing Optics::nextInside(LightPath& path) const {
  const GlassBox::Hit wall = box_.fromInside(path.origin, path.direction);
  const SurfaceHit hit = path.solid >= 0 ? rays_.nearestSolid(path.origin, path.direction, wall.distance)
                                         : rays_.nearest(path.origin, path.direction, wall.distance);
  const bool free = hit.kind == SurfaceKind::none;
  const float distance = free ? wall.distance : hit.distance;
  path.origin += distance * path.direction;
  Crossing crossing{.kind = Boundary::clear, .behind = path};
  if (path.solid >= 0)
    crossing.passed = passedShare(glassAbsorption_, distance);
  else if (path.inWater)
    crossing.passed = passedShare(waterAbsorption_, distance);
  if (free) return leaveInside(path, wall, crossing);
  meetSurface(path, hit, crossing);
  return crossing;
}

/// The table is taken to touch what stands on it, so that light reaches it without an air gap.
Crossing Optics::leaveInside(LightPath& path, const GlassBox::Hit& wall, Crossing crossing) const {
  crossing.normal = -GlassBox::outward(wall.face);
  if (!box_.isPane(wall.face) && wall.face == 2) {
    crossing.kind = Boundary::table;
    return crossing;
  }
  crossing.behind.place = box_.isPane(wall.face) ? Place::glass : Place::outside;
  crossing.behind.inWater = false;
  crossing.behind.solid = -1;
  refractOrMirror(path, crossing);
  return crossing;
}

void Optics::meetSurface(const LightPath& path, const SurfaceHit& hit, Crossing& crossing) const {
  if (hit.kind == SurfaceKind::bubble) return meetSkin(path, hit.index, crossing);
  crossing.normal = hit.entering ? hit.normal : Vec3(-hit.normal);
  if (hit.kind == SurfaceKind::water) {
    crossing.behind.inWater = hit.entering;
  } else if (scene_.solids[hit.index].material == Material::matte) {
    crossing.kind = Boundary::matte;
    return;
  } else {
    crossing.behind.solid = hit.entering ? hit.index : -1;
    if (!hit.entering) crossing.behind.inWater = liquidAt(path.origin);
  }
  refractOrMirror(path, crossing);
}

/// A path outside all bubbles meets the skin of one.
void Optics::meetSkin(const LightPath& path, int bubble, Crossing& crossing) const {
  if (films_) bubble = bubbleBehindSkin(path, bubble);
  crossing.bubble = bubble;
  crossing.behind.bubble = bubble;
  const int wall = films_ ? cells_.wallAt(bubble, path.origin) : BubbleCells::kSkin;
  const Face skin = wall == BubbleCells::kSkin ? faceAt(path, bubble, wall) : wallFace(path, bubble, wall);
  crossing.border = skin.share;
  if (!path.inWater) return crossFilm(path, skin, -1, crossing);
  crossing.normal = skin.normal;
  refractOrMirror(path, crossing);
}

/// At a wall curved films stand elsewhere than the planes that told whose skin was met: the bubble on this
/// side of the first film is.
int Optics::bubbleBehindSkin(const LightPath& path, int bubble) const {
  BubbleCells::Stretch open{0, 0, BubbleCells::kSkin, BubbleCells::kSkin};
  FilmSurfaces::Hit hit;
  const bool meets = cells_.cutByWalls(bubble, path.origin, path.direction, open) && open.out > 0 &&
                     films_->meet(path.origin, path.direction, open.out, hit);
  return meets && cells_.holds(hit.near, path.origin) ? hit.near : bubble;
}

float Optics::borderOf(int bubble) const {
  return static_cast<float>(scene_.look.plateauBorder) * cells_.radius(bubble);
}

Optics::Face Optics::faceAt(const LightPath& path, int bubble, int face) const {
  const Rounding rounded = cells_.roundedAt(bubble, face, path.origin, borderOf(bubble));
  const float side = path.bubble == bubble ? -1.0f : 1.0f;
  Vec3 exact = side * cells_.normalAt(bubble, face, path.origin);
  if (exact.dot(path.direction) > 0) exact = -exact;
  return {facing(side * rounded.normal, exact, path.direction), exact, rounded.share};
}

/// The face of a bubble at a wall, with the borders of its curved films.
Optics::Face Optics::wallFace(const LightPath& path, int bubble, int face) const {
  const Vec3& flat = cells_.planeNormal(face);
  const Rounding rounded = films_->roundedAtWall(bubble, path.origin, flat, borderOf(bubble));
  const float side = flat.dot(path.direction) > 0 ? -1.0f : 1.0f;
  const Vec3 exact = side * flat;
  return {facing(side * rounded.normal, exact, path.direction), exact, rounded.share};
}

Crossing Optics::nextInBubble(LightPath& path) const {
  int other = -1;
  const Face wall = films_ ? leaveByFilms(path, other) : leaveByPlanes(path, other);
  Crossing crossing{.kind = Boundary::clear, .bubble = path.bubble, .behind = path};
  crossing.border = wall.share;
  crossing.behind.bubble = other;
  if (other < 0) crossing.behind.inWater = liquidAt(path.origin);
  if (other >= 0 || !crossing.behind.inWater) {
    crossFilm(path, wall, other, crossing);
  } else {
    crossing.normal = wall.normal;
    refractOrMirror(path, crossing);
  }
  return crossing;
}

/// Cells of neighbours share their faces, so the way through a foam needs no search.
Optics::Face Optics::leaveByPlanes(LightPath& path, int& other) const {
  BubbleCells::Stretch stretch{0, 0, BubbleCells::kSkin, BubbleCells::kSkin};
  const bool inside = cells_.cut(path.bubble, path.origin, path.direction, stretch) && stretch.out > 0;
  const int face = inside ? stretch.faceOut : BubbleCells::kSkin;
  if (inside) path.origin += stretch.out * path.direction;
  other = face == BubbleCells::kSkin ? -1 : cells_.neighbour(face);
  return faceAt(path, path.bubble, face);
}

/// A film that the ray meets knows better which bubble it comes from. Where there is none before the skin,
/// the ray has gone through the gap that the chords of a film's rim leave if another ball reaches beyond.
Optics::Face Optics::leaveByFilms(LightPath& path, int& other) const {
  BubbleCells::Stretch open{0, 0, BubbleCells::kSkin, BubbleCells::kSkin};
  const bool inside = cells_.cutByWalls(path.bubble, path.origin, path.direction, open) && open.out > 0;
  FilmSurfaces::Hit hit;
  if (inside && films_->meet(path.origin, path.direction, open.out, hit)) {
    path.bubble = hit.near, other = hit.far;
    path.origin += hit.distance * path.direction;
    const Rounding rounded = films_->rounded(hit, path.origin, borderOf(hit.near));
    const Vec3 exact = -hit.normal;
    return {facing(-rounded.normal, exact, path.direction), exact, rounded.share};
  }
  if (inside) path.origin += open.out * path.direction;
  if (inside && open.faceOut != BubbleCells::kSkin) return wallFace(path, path.bubble, open.faceOut);
  other = cells_.beyondSkin(path.bubble, path.origin);
  return faceAt(path, path.bubble, BubbleCells::kSkin);
}

/// Fresnel and Snell between the media on the two sides.
void Optics::refractOrMirror(const LightPath& path, Crossing& crossing) const {
  const float front = indexOf(path), back = indexOf(crossing.behind), eta = back / front;
  if (front == back) return;
  const float cosIn = std::min(1.0f, -path.direction.dot(crossing.normal));
  const float share = fresnelReflectance(cosIn, eta);
  crossing.mirrored = Vec3::Constant(diagram_ ? std::min(share, kDiagramMirror) : share);
  if (share < 1 && !diagram_) crossing.behind.direction = refract(path.direction, crossing.normal, eta);
}

/// A film with air on both sides. Its Plateau border is a prism of water: no interference, light turned
/// towards the film's middle, a part of it scattered.
void Optics::crossFilm(const LightPath& path, const Face& film, int other, Crossing& crossing) const {
  crossing.normal = film.normal;
  const float cosIn = std::clamp(-path.direction.dot(film.normal), 0.0f, 1.0f);
  const Vec3 thin = filmReflectance(cosIn, filmThickness(crossing.bubble, other, path.origin));
  const Vec3 thick = Vec3::Constant(sheetReflectance(cosIn, kWaterIndex));
  crossing.mirrored = thin + film.share * (thick - thin);
  crossing.scattered = kHaze + (kBorderScatter - kHaze) * film.share;
  if (film.share <= 0) return;
  constexpr float kPrism = 0.5f;  // turn of the light over the lean of the surface, by eye
  crossing.behind.direction = (path.direction + kPrism * (film.normal - film.exact)).normalized();
}

float Optics::filmThickness(int bubble, int other, const Vec3& p) const {
  const auto idOf = [&](int b) {
    return b < 0                     ? ~std::uint64_t{0}
           : scene_.bubbleId.empty() ? static_cast<std::uint64_t>(b)
                                     : scene_.bubbleId[b];
  };
  const float age = scene_.bubbleAge.empty() ? 0 : static_cast<float>(scene_.bubbleAge[bubble]);
  return apps::filmThickness(scene_.look, idOf(bubble), idOf(other), age,
                             (p - cells_.centre(bubble)) / cells_.radius(bubble));
}

float Optics::indexOf(const LightPath& path) const {
  if (path.bubble >= 0 || path.place == Place::outside) return 1;
  if (path.place == Place::glass || path.solid >= 0) return kGlassIndex;
  return path.inWater ? kWaterIndex : 1;
}

/// Finds what a path that has just come into the box is inside of.
void Optics::settle(LightPath& path) const {
  path.inWater = liquidAt(path.origin);
  path.solid = -1;
  for (std::size_t s = 0; s < scene_.solids.size(); ++s)
    if (scene_.solids[s].material == Material::glass &&
        scene_.solids[s].distance(path.origin.cast<double>()) < 0)
      path.solid = static_cast<int>(s);
}

bool Optics::liquidAt(const Vec3& p) const {
  const Vec3 origin = scene_.grid.origin.cast<float>();
  const Vec3 cells = (p - origin) / static_cast<float>(scene_.grid.dx) - Vec3::Constant(0.5f);
  Eigen::Vector3i c;
  Vec3 f;
  for (int a = 0; a < 3; ++a) {
    const float inside = std::clamp(cells[a], 0.0f, scene_.grid.cells[a] - 1.0f);
    c[a] = std::min(static_cast<int>(inside), scene_.grid.cells[a] - 2);
    f[a] = inside - static_cast<float>(c[a]);
  }
  float phi = 0;
  for (int n = 0; n < 8; ++n) {
    const Eigen::Vector3i o(n & 1, n >> 1 & 1, n >> 2 & 1);
    float weight = 1;
    for (int a = 0; a < 3; ++a) weight *= o[a] ? f[a] : 1 - f[a];
    phi += weight * scene_.phi(c + o);
  }
  return phi < 0;
}

}  // namespace spume::apps
