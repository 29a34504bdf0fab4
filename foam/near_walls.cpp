#include "foam/near_walls.h"

#include "foam/errors.h"

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

/// Bubbles that may touch a further wall, and the points from which they look for it.
struct Feelers {
  std::vector<std::size_t> owner;
  Eigen::Matrix3Xd offset, point;

  Feelers(const BubbleStore& bubbles, const std::vector<double>& reach, const std::vector<NearWalls>& walls,
          int round) {
    for (std::size_t i = 0; i < walls.size(); ++i)
      if (walls[i].count == round && walls[i].wall[0].psi < reach[i]) owner.push_back(i);
    offset.setZero(3, static_cast<Eigen::Index>(owner.size()));
    point.resize(3, offset.cols());
    for (Eigen::Index f = 0; f < offset.cols(); ++f) {
      const NearWalls& known = walls[owner[f]];
      for (int k = 0; k < known.count; ++k) offset.col(f) += bubbles.radius[owner[f]] * known.wall[k].away;
      point.col(f) = bubbles.position[owner[f]] + offset.col(f);
    }
  }
};

/// One round: every bubble with `round` known walls looks for the next.
void feel(const LiquidSampler& liquid, const BubbleStore& bubbles, const std::vector<double>& reach,
          int round, std::vector<NearWalls>& walls) {
  const Feelers feelers(bubbles, reach, walls, round);
  const Eigen::Index n = feelers.point.cols();
  if (n == 0) return;
  Eigen::VectorXd psi(n);
  Eigen::Matrix3Xd away(3, n), velocity(3, n);
  Eigen::VectorXi solid(n);
  liquid.psi(feelers.point, psi), liquid.gradPsi(feelers.point, away);
  liquid.solidVelocity(feelers.point, velocity), liquid.solidIndex(feelers.point, solid);
  if (!psi.allFinite() || !away.allFinite() || !velocity.allFinite())
    throw NumericalFailure("the liquid sampler returned a psi, gradPsi or solidVelocity that is not finite");
  for (Eigen::Index f = 0; f < n; ++f) {
    NearWalls& known = walls[feelers.owner[f]];
    const double here = psi[f] - away.col(f).dot(feelers.offset.col(f));
    if (here < reach[feelers.owner[f]] && isNew(known, away.col(f)))
      known.wall[known.count++] = {here, away.col(f), velocity.col(f), solid[f]};
  }
}

}  // namespace

void findNearWalls(const LiquidSampler& liquid, const Surroundings& around, const BubbleStore& bubbles,
                   const std::vector<double>& reach, std::vector<NearWalls>& walls) {
  walls.assign(bubbles.size(), {});
  for (std::size_t i = 0; i < walls.size(); ++i) {
    const Eigen::Vector3d away = around.gradPsi.col(i);
    if (away.norm() == 0) continue;
    walls[i].wall[walls[i].count++] = {around.psi[i], away, around.solidVelocity.col(i), around.solid[i]};
  }
  feel(liquid, bubbles, reach, 1, walls);
  feel(liquid, bubbles, reach, 2, walls);
}

}  // namespace spume::foam
