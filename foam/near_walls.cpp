#include "foam/near_walls.h"

#include <algorithm>
#include <cmath>

#include "foam/errors.h"
#include "foam/failure_text.h"
#include "foam/parallel.h"

namespace spume::foam {
namespace {

constexpr double kSameWall = 0.9;  // cosine: normals closer than 26 degrees are one bent wall
constexpr double kClearSlope =
    0.5;  // a gradient shorter than this belongs to a ridge between walls, not to a wall

bool isNew(const NearWalls& known, const Eigen::Vector3d& away) {
  for (int k = 0; k < known.count; ++k)
    if (known.wall[k].away.dot(away) > kSameWall) return false;
  return away.norm() > kClearSlope;
}

/// How far from the walls it knows a bubble looks for the next: by its radius, or by all it may move.
enum class Look { near, far };

/// Bubbles that may touch a further wall, and the points from which they look for it.
struct Feelers {
  std::vector<std::size_t> owner;
  Eigen::Matrix3Xd offset, point;

  /// Of those of the bubbles `close` to a wall that know so many.
  Feelers(const BubbleStore& bubbles, const std::vector<double>& reach, const std::vector<std::size_t>& close,
          const std::vector<NearWalls>& walls, int known, Look look) {
    for (const std::size_t i : close)
      if (walls[i].count == known) owner.push_back(i);
    offset.setZero(3, static_cast<Eigen::Index>(owner.size()));
    point.resize(3, offset.cols());
    for (Eigen::Index f = 0; f < offset.cols(); ++f) {
      const std::size_t i = owner[f];
      for (int k = 0; k < known; ++k) {
        const NearWall& wall = walls[i].wall[k];
        const double room = look == Look::far ? reach[i] - wall.psi : 0;
        offset.col(f) += std::max(bubbles.radius[i], room) * wall.away;
      }
      point.col(f) = bubbles.position[i] + offset.col(f);
    }
  }
};

/// One round: every bubble close to a wall with `count` known walls looks for the next. What is seen from
/// afar counts only if a flat wall there could be: the feeler is in free space, and the wall is not nearer
/// than the nearest.
void feel(const LiquidSampler& liquid, const BubbleStore& bubbles, const std::vector<double>& reach,
          const std::vector<std::size_t>& close, int count, Look look, std::vector<NearWalls>& walls) {
  const Feelers feelers(bubbles, reach, close, walls, count, look);
  const Eigen::Index n = feelers.point.cols();
  if (n == 0) return;
  Eigen::VectorXd psi(n);
  Eigen::Matrix3Xd away(3, n), velocity(3, n);
  Eigen::VectorXi solid(n);
  liquid.psi(feelers.point, psi), liquid.gradPsi(feelers.point, away);
  liquid.solidVelocity(feelers.point, velocity), liquid.solidIndex(feelers.point, solid);
  if (!psi.allFinite() || !away.allFinite() || !velocity.allFinite())
    for (Eigen::Index f = 0; f < n; ++f)
      if (!std::isfinite(psi[f]) || !away.col(f).allFinite() || !velocity.col(f).allFinite())
        throw NumericalFailure(joined("foam: the liquid sampler returned psi = ", psi[f], ", gradPsi = ",
                                      textOf(away.col(f)), ", solidVelocity = ", textOf(velocity.col(f)),
                                      ", not all finite, at ", textOf(feelers.point.col(f)), " m, where ",
                                      placeOf(bubbles, feelers.owner[f]), " looks for walls"));
  for (Eigen::Index f = 0; f < n; ++f) {
    NearWalls& known = walls[feelers.owner[f]];
    const double here = psi[f] - away.col(f).dot(feelers.offset.col(f));
    if (look == Look::far && (psi[f] <= 0 || here < known.wall[0].psi)) continue;
    if (here < reach[feelers.owner[f]] && isNew(known, away.col(f)))
      known.wall[known.count++] = {here, away.col(f), velocity.col(f), solid[f]};
  }
}

}  // namespace

void WallSearch::find(const LiquidSampler& liquid, const Surroundings& around, const BubbleStore& bubbles,
                      const std::vector<double>& reach, std::vector<NearWalls>& walls) {
  walls.resize(bubbles.size());
  forEachIndex(walls.size(), [&](std::size_t i) {
    walls[i].count = 0;
    const Eigen::Vector3d away = around.gradPsi.col(i);
    if (away.norm() == 0) return;
    walls[i].wall[walls[i].count++] = {around.psi[i], away, around.solidVelocity.col(i), around.solid[i]};
  });
  findFurther(liquid, around, bubbles, reach, walls);
}

void WallSearch::findAgain(const LiquidSampler& liquid, const Surroundings& around,
                           const BubbleStore& bubbles, const std::vector<double>& reach,
                           std::vector<NearWalls>& walls) {
  for (const std::size_t i : close_) walls[i].count = std::min(walls[i].count, 1);
  findFurther(liquid, around, bubbles, reach, walls);
}

/// Finds those beyond the nearest, which are known.
void WallSearch::findFurther(const LiquidSampler& liquid, const Surroundings& around,
                             const BubbleStore& bubbles, const std::vector<double>& reach,
                             std::vector<NearWalls>& walls) {
  close_.clear();
  for (std::size_t i = 0; i < walls.size(); ++i)
    if (around.psi[i] < reach[i]) close_.push_back(i);
  for (const Look look : {Look::near, Look::far})
    for (const int count : {1, 2}) feel(liquid, bubbles, reach, close_, count, look, walls);
}

void findNearWalls(const LiquidSampler& liquid, const Surroundings& around, const BubbleStore& bubbles,
                   const std::vector<double>& reach, std::vector<NearWalls>& walls) {
  WallSearch().find(liquid, around, bubbles, reach, walls);
}

}  // namespace spume::foam
