#include "foam/edge_batch.h"

#include <cmath>
#include <numbers>

namespace spume::foam {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kAngleRoundOff = 1e-15;  ///< of one edge's angle, a few ulp of pi
constexpr std::size_t kBatchEdges = 256;  ///< their columns stay in the nearest cache

/// An edge in each lane.
struct Edge {
  Lanes side, side2;  ///< |D| [m], and squared
  Lanes t1, t2;

  /// Of the triangle from the disc's centre, for a centre at that height from its plane.
  Lanes solidShortfall(const Lanes& height) const {
    const Lanes height2 = height * height;
    const Lanes r1 = squareRoot(height2 + side2 + t1 * t1), r2 = squareRoot(height2 + side2 + t2 * t2);
    const Lanes turn = height * side * (t2 * r1 - t1 * r2);  // >= 0 but for round-off, as t/R grows with t
    return upperAngle<Lanes>(turn > 0 ? turn : Lanes{}, side2 * r1 * r2 + height2 * (t1 * t2));
  }
};

}  // namespace

bool EdgeBatch::add(const DiscLines& lines, std::size_t disc, const DiscBalls& balls, FilmShape& film) {
  const std::size_t begin = edges_.count;
  const DiscLines::Rest rest = lines.clip(disc, edges_);
  if (!rest.any) return false;
  noteHeights(begin, balls);
  discs_.push_back({balls, lines.discRadius2(disc), edges_.count, rest.centreInside, rest.closed, &film});
  if (edges_.count > kBatchEdges) flush();
  return true;
}

void EdgeBatch::noteHeights(std::size_t begin, const DiscBalls& balls) {
  edges_.reserve(edges_.count);
  nearHeight_.resize(edges_.offset.size()), farHeight_.resize(edges_.offset.size());
  for (std::size_t k = begin; k < edges_.count; k += kLanes) {
    storeLanes(&nearHeight_[k], Lanes{} + std::abs(balls.height));
    storeLanes(&farHeight_[k], Lanes{} + std::abs(balls.farHeight));
  }
}

void EdgeBatch::integrateEdges() {
  for (auto* column : {&triangle_, &areaShift_, &spanned_, &nearSolid_, &farSolid_})
    column->resize(edges_.offset.size());
  const Lanes zero = {};
  for (std::size_t k = 0; k < edges_.count; k += kLanes) {
    const Lanes offset = loadLanes(&edges_.offset[k]), t1 = loadLanes(&edges_.t1[k]),
                t2 = loadLanes(&edges_.t2[k]), length = t2 - t1;
    const Lanes sign = offset < 0 ? zero - 1 : zero + 1, side = sign * offset;
    const Edge edge{side, side * side, t1, t2};
    storeLanes(&triangle_[k], offset * length);
    storeLanes(&areaShift_[k], loadLanes(&edges_.shift[k]) * length);
    storeLanes(&spanned_[k], sign * upperAngle<Lanes>(side * length, edge.side2 + t1 * t2));
    storeLanes(&nearSolid_[k], sign * edge.solidShortfall(loadLanes(&nearHeight_[k])));
    storeLanes(&farSolid_[k], sign * edge.solidShortfall(loadLanes(&farHeight_[k])));
  }
}

EdgeBatch::Sums EdgeBatch::sumOf(std::size_t begin, std::size_t end) const {
  Sums sums;
  for (std::size_t k = begin; k < end; ++k) {
    sums.triangles += triangle_[k], sums.shifts += areaShift_[k];
    sums.near += nearSolid_[k], sums.far += farSolid_[k], sums.spanned += spanned_[k];
  }
  return sums;
}

/// With the disc's centre c as corner, an edge at distance D from t1 to t2 adds a triangle and takes its
/// angle from the rim; the rim adds sectors of the disc and of the cap. Without a rim the edges go all around
/// c or not at all.
void EdgeBatch::flush() {
  integrateEdges();
  std::size_t begin = 0;
  for (const Disc& disc : discs_) {
    const DiscBalls& balls = disc.balls;
    const Sums sums = sumOf(begin, disc.end);
    const double whole = disc.centreInside ? 2 * kPi : 0;
    const double roundOff = kAngleRoundOff * static_cast<double>(disc.end - begin);
    const double angle = disc.closed || whole - sums.spanned < roundOff ? whole : sums.spanned;
    FilmShape& film = *disc.film;
    film.arc = whole - angle;
    film.area = (sums.triangles + disc.discRadius2 * film.arc) / 2;
    film.areaShift = static_cast<float>(
        sums.shifts + film.arc * (balls.radius * balls.radiusShift - balls.height * balls.heightShift));
    film.heightShift = static_cast<float>(balls.heightShift);
    film.solidNear = angle - sums.near + (1 - std::abs(balls.height) / balls.radius) * film.arc;
    film.solidFar = angle - sums.far + (1 - std::abs(balls.farHeight) / balls.farRadius) * film.arc;
    begin = disc.end;
  }
  discs_.clear();
  edges_.count = 0;
}

}  // namespace spume::foam
