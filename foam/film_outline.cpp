#include "foam/film_outline.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "foam/wall_cells.h"

namespace spume::foam {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kSameWall = 0.9;      ///< cosine: walls of two bubbles with normals this near are one
constexpr double kRoundOffArc = 1e-9;  ///< angle that sums of edges leave of a rim cut off wholly

}  // namespace

void FilmOutlines::trace(const Film& film, FilmOutline& outline) {
  const Vector3d& first = bubbles_.position[film.i];
  const double radius = bubbles_.radius[film.i];
  outline.edges.clear();
  outline.normal = (bubbles_.position[film.j] - first) / film.distance;
  outline.centre = first + film.height * outline.normal;
  outline.discRadius = std::sqrt(std::max(0.0, radius * radius - film.height * film.height));
  across_ = outline.normal.unitOrthogonal(), upward_ = outline.normal.cross(across_);
  lines_.clear();
  addThirds(film, outline);
  if (!walls_.empty()) addWalls(film, outline);
  clip(outline);
}

/// The plane { first centre + p : step . p = height } cuts the disc if its line does.
void FilmOutlines::addLine(const Film& film, const FilmOutline& outline, std::int32_t third,
                           const Vector3d& step, double height) {
  const double along = step.dot(outline.normal);
  const Vector2d inPlane(step.dot(across_), step.dot(upward_));
  const double reach = inPlane.norm(), room = height - film.height * along;
  if (reach > 0 && room < outline.discRadius * reach)
    lines_.push_back({third, inPlane / reach, room / reach, along / film.distance, reach});
}

/// A border belongs to three films, so only bubbles in contact with both can cut this one.
void FilmOutlines::addThirds(const Film& film, const FilmOutline& outline) {
  const auto isContact = [&](std::int32_t e) { return topology_.overlaps[neighbours_.pair[e]].film >= 0; };
  const double weight = bubbles_.radius[film.i] * bubbles_.radius[film.i];
  std::int32_t a = neighbours_.start[film.i], b = neighbours_.start[film.j];
  const std::int32_t endA = neighbours_.start[film.i + 1], endB = neighbours_.start[film.j + 1];
  while (a < endA && b < endB) {
    const std::int32_t k = neighbours_.other[a], l = neighbours_.other[b];
    if (k == l && isContact(a) && isContact(b)) {
      const Vector3d step = bubbles_.position[k] - bubbles_.position[film.i];
      const double other = bubbles_.radius[k] * bubbles_.radius[k];
      addLine(film, outline, k, step, (step.squaredNorm() + weight - other) / 2);
    }
    a += k <= l, b += l <= k;
  }
}

/// The walls that cut either cell; one that cuts both counts once.
void FilmOutlines::addWalls(const Film& film, const FilmOutline& outline) {
  std::array<Vector3d, 2 * std::tuple_size_v<decltype(NearWalls::wall)>> known;
  std::size_t count = 0;
  for (const std::int32_t b : {film.i, film.j})
    for (int w = 0; w < walls_[b].count; ++w) {
      const NearWall& wall = walls_[b].wall[w];
      if (std::abs(wall.psi) >= kCutByWall * bubbles_.radius[b]) continue;
      const Vector3d into = -wall.away.normalized();
      const auto isSame = [&](const Vector3d& other) { return other.dot(into) > kSameWall; };
      if (std::any_of(known.begin(), known.begin() + count, isSame)) continue;
      known[count++] = into;
      addLine(film, outline, -1, into, wall.psi + into.dot(bubbles_.position[b] - bubbles_.position[film.i]));
    }
}

/// Cuts each line by the disc and all others. With the disc's centre as corner, an edge at distance D adds a
/// triangle and takes its angle from the rim.
void FilmOutlines::clip(FilmOutline& outline) const {
  const double disc2 = outline.discRadius * outline.discRadius;
  bool centreInside = true, open = lines_.empty();
  double spanned = 0;
  Vector2d moment = Vector2d::Zero(), pull = Vector2d::Zero();
  for (const Line& line : lines_) {
    const Vector2d along(-line.u.y(), line.u.x());
    const double half = std::sqrt(std::max(0.0, disc2 - line.offset * line.offset));
    double from = -half, to = half;
    for (const Line& other : lines_) {
      if (&other == &line) continue;
      const double slope = other.u.dot(along), gap = other.offset - line.offset * other.u.dot(line.u);
      if (slope > 0) to = std::min(to, gap / slope);
      if (slope < 0) from = std::max(from, gap / slope);
      if (slope == 0 && gap < 0) to = from;
    }
    centreInside = centreInside && line.offset >= 0;
    if (!(to > from)) continue;
    open = open || from == -half || to == half;
    const double length = to - from;
    const Vector2d middle = line.offset * line.u + (from + to) / 2 * along;
    spanned += std::atan2(line.offset * length, line.offset * line.offset + from * to);
    pull -= length * line.u, moment += line.offset * length / 3 * middle;
    const auto at = [&](const Vector2d& q) -> Vector3d {
      return outline.centre + q.x() * across_ + q.y() * upward_;
    };
    const Vector2d foot = line.offset * line.u;
    outline.edges.push_back({line.third, length, at(middle), at(foot + from * along), at(foot + to * along),
                             line.lean, line.reach});
  }
  outline.arc = open ? (centreInside ? 2 * std::numbers::pi : 0) - spanned : 0;
  if (outline.arc < kRoundOffArc)
    outline.arc = 0;
  else
    moment += disc2 / 3 * pull;
  // All normals around a closed outline add up to nothing.
  outline.arcPull = pull.x() * across_ + pull.y() * upward_;
  outline.moment = moment.x() * across_ + moment.y() * upward_;
}

}  // namespace spume::foam
