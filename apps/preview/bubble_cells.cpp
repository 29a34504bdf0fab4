#include "apps/preview/bubble_cells.h"

#include <algorithm>
#include <cmath>

#include "fluid/parallel.h"
#include "foam/overlap_pairs.h"

namespace spume::apps {
namespace {

/// Liquid left between a bubble and a wall it touches: as a share of the box (just above the rounding of
/// float positions) and, at solids, which may curve away from their tangent plane, of the radius.
constexpr float kOnFace = 1e-3f;  ///< of the radius: a point this near lies on a face
constexpr double kWallGap = 1e-5, kSolidGap = 0.02;

/// Outward unit normal of a solid at `x`, by central differences over `step` [m].
Eigen::Vector3d gradientOf(const PreviewSolid& solid, const Eigen::Vector3d& x, double step) {
  Eigen::Vector3d g;
  for (int a = 0; a < 3; ++a) {
    const Eigen::Vector3d h = step * Eigen::Vector3d::Unit(a);
    g[a] = solid.distance(x + h) - solid.distance(x - h);
  }
  return g.norm() > 0 ? Eigen::Vector3d(g.normalized()) : Eigen::Vector3d::UnitY();
}

}  // namespace

BubbleCells::BubbleCells(const PreviewScene& scene) {
  const std::size_t count = scene.bubblePosition.size();
  centre_.resize(count), radius_.resize(count);
  for (std::size_t b = 0; b < count; ++b) {
    centre_[b] = scene.bubblePosition[b].cast<float>();
    radius_[b] = static_cast<float>(scene.bubbleRadius[b]);
  }
  build(scene);
}

void BubbleCells::build(const PreviewScene& scene) {
  foam::OverlapPairs pairs;
  pairs.update({scene.bubblePosition.begin(), scene.bubblePosition.end()},
               {scene.bubbleRadius.begin(), scene.bubbleRadius.end()});
  std::vector<std::vector<Face>> faces(size());
  tbb::parallel_for(0, size(), [&](int b) {
    std::vector<std::int32_t> candidates;
    const int rank = pairs.rank()[b];
    for (int s = pairs.rowStart()[rank]; s < pairs.rowStart()[rank + 1]; ++s)
      candidates.push_back(pairs.order()[pairs.candidate()[s]]);
    neighbourFaces(scene, b, candidates, faces[b]);
    wallFaces(scene, b, faces[b]);
  });
  faceStart_.assign(1, 0);
  for (const std::vector<Face>& own : faces) {
    for (const Face& face : own) {
      plane_.push_back(face.plane);
      neighbour_.push_back(face.neighbour);
      curvature_.push_back(face.curvature);
    }
    faceStart_.push_back(static_cast<std::int32_t>(plane_.size()));
  }
}

/// Radical planes that cut the ball; a ball wholly beyond one of them is swallowed and gets radius 0.
void BubbleCells::neighbourFaces(const PreviewScene& scene, int bubble,
                                 const std::vector<std::int32_t>& candidates, std::vector<Face>& faces) {
  const Eigen::Vector3d& x = scene.bubblePosition[bubble];
  const double r = scene.bubbleRadius[bubble];
  for (const std::int32_t other : candidates) {
    const Eigen::Vector3d offset = scene.bubblePosition[other] - x;
    const double s = scene.bubbleRadius[other], d = offset.norm();
    if (d >= r + s) continue;
    if (d == 0) {  // coincident: the larger one stays, then the first
      if (s > r || (s == r && other < bubble)) radius_[bubble] = 0;
      continue;
    }
    const double height = (d + (r - s) * (r + s) / d) / 2;
    if (height >= r) continue;
    if (height <= -r) radius_[bubble] = 0;
    faces.push_back(
        {{(offset / d).cast<float>(), static_cast<float>(height)}, other, static_cast<float>(1 / r - 1 / s)});
  }
}

void BubbleCells::wallFaces(const PreviewScene& scene, int bubble, std::vector<Face>& faces) const {
  const Eigen::Vector3d& x = scene.bubblePosition[bubble];
  const double r = scene.bubbleRadius[bubble], gap = kWallGap * (scene.upper - scene.lower).maxCoeff();
  const auto add = [&](const Eigen::Vector3d& outward, double height) {
    if (height < r) faces.push_back({{outward.cast<float>(), static_cast<float>(height)}, kWall, 0.0f});
  };
  for (int a = 0; a < 3; ++a) {
    add(-Eigen::Vector3d::Unit(a), x[a] - scene.lower[a] - gap);
    add(Eigen::Vector3d::Unit(a), scene.upper[a] - x[a] - gap);
  }
  for (const PreviewSolid& solid : scene.solids)
    if (const double psi = solid.distance(x); psi < r)
      add(-gradientOf(solid, x, 0.1 * r), psi - gap - kSolidGap * r);
}

template <typename Counts>
bool BubbleCells::cutWhere(int bubble, const Vec3& origin, const Vec3& direction, const Counts& counts,
                           Stretch& stretch) const {
  const Vec3 o = origin - centre_[bubble];
  const float along = o.dot(direction);
  const float gap = radius_[bubble] * radius_[bubble] - (o - along * direction).squaredNorm();
  if (gap <= 0) return false;
  const float half = std::sqrt(gap);
  stretch = {-along - half, -along + half, kSkin, kSkin};
  for (int f = firstFace(bubble); f < endFace(bubble); ++f) {
    if (!counts(f)) continue;
    const Plane& plane = plane_[f];
    const float speed = plane.normal.dot(direction), distance = plane.height - plane.normal.dot(o);
    // Most planes lie beyond what is found already: they are passed over without a division.
    if (speed > 0) {
      if (distance >= stretch.out * speed) continue;
      stretch.out = distance / speed, stretch.faceOut = f;
    } else if (speed < 0) {
      if (distance >= stretch.in * speed) continue;
      stretch.in = distance / speed, stretch.faceIn = f;
    } else {
      if (distance < 0) return false;
      continue;
    }
    if (stretch.in >= stretch.out) return false;
  }
  return true;
}

bool BubbleCells::cut(int bubble, const Vec3& origin, const Vec3& direction, Stretch& stretch) const {
  return cutWhere(
      bubble, origin, direction, [](int) { return true; }, stretch);
}

bool BubbleCells::cutByWalls(int bubble, const Vec3& origin, const Vec3& direction, Stretch& stretch) const {
  return cutWhere(
      bubble, origin, direction, [&](int f) { return neighbour_[f] == kWall; }, stretch);
}

int BubbleCells::beyondSkin(int bubble, const Vec3& p) const {
  float farthest = kOnFace * radius_[bubble];
  int other = -1;
  for (int f = firstFace(bubble); f < endFace(bubble); ++f) {
    const float beyond = plane_[f].normal.dot(p - centre_[bubble]) - plane_[f].height;
    if (neighbour_[f] != kWall && beyond > farthest) farthest = beyond, other = neighbour_[f];
  }
  return other;
}

int BubbleCells::wallAt(int bubble, const Vec3& p) const {
  for (int f = firstFace(bubble); f < endFace(bubble); ++f)
    if (neighbour_[f] == kWall &&
        std::abs(plane_[f].normal.dot(p - centre_[bubble]) - plane_[f].height) < kOnFace * radius_[bubble])
      return f;
  return kSkin;
}

bool BubbleCells::holds(int bubble, const Vec3& p) const {
  return (p - centre_[bubble]).norm() < (1 + kOnFace) * radius_[bubble];
}

Vec3 BubbleCells::normalAt(int bubble, int face, const Vec3& p) const {
  const Vec3 offset = p - centre_[bubble];
  if (face == kSkin) return offset.normalized();
  const Plane& plane = plane_[face];
  return (plane.normal + curvature_[face] * (offset - plane.height * plane.normal)).normalized();
}

/// The nearest other face is met at the distance, along this one, of its plane or of the film's rim. The
/// normal turns by the share of the border towards the direction that lies in that other face's mirror
/// plane, so that the surfaces of two bubbles join without a crease.
Rounding BubbleCells::roundedAt(int bubble, int face, const Vec3& p, float width) const {
  constexpr float kParallel = 1e-3f;  // sine below which two directions have no plane of their own
  Rounding rounded{normalAt(bubble, face, p), 0};
  if (width <= 0) return rounded;
  const Vec3 offset = p - centre_[bubble];
  const Vec3 flat = face == kSkin ? rounded.normal : plane_[face].normal;
  float nearest = width;
  Vec3 towards = Vec3::Zero();
  if (face != kSkin) {  // the rim of the film, where the bubble's skin begins
    const Vec3 across = offset - plane_[face].height * flat;
    const float h = plane_[face].height, from = across.norm();
    const float rim = std::sqrt(std::max(0.0f, radius_[bubble] * radius_[bubble] - h * h));
    if (rim - from < nearest && from > 0) nearest = rim - from, towards = across / from;
  }
  for (int f = firstFace(bubble); f < endFace(bubble); ++f) {
    const float distance = plane_[f].height - plane_[f].normal.dot(offset);
    if (f == face || distance >= nearest) continue;  // along the face it is farther still
    const Vec3 inFace = plane_[f].normal - plane_[f].normal.dot(flat) * flat;
    const float lean = inFace.norm();
    if (distance >= nearest * lean || lean <= kParallel) continue;
    nearest = distance / lean;
    towards = face == kSkin ? plane_[f].normal : Vec3(inFace / lean);
  }
  if (nearest >= width) return rounded;
  rounded.share = borderShare(nearest, width);
  if (face == kSkin) {
    const Vec3 middle = flat - flat.dot(towards) * towards;
    if (middle.norm() > kParallel) rounded.normal += rounded.share * (middle.normalized() - rounded.normal);
  } else {
    rounded.normal -= kFilmTurn * rounded.share * towards;
  }
  rounded.normal.normalize();
  return rounded;
}

}  // namespace spume::apps
