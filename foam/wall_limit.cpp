#include "foam/wall_limit.h"

#include <algorithm>
#include <vector>

#include "foam/index_list.h"

namespace spume::foam {
namespace {

/// Times a bubble is moved towards the surface of its solid: psi is interpolated, and less steep than a true
/// distance near edges and in thin walls.
constexpr int kRounds = 4;

/// Depth left after a move that is nobody's business [r].
constexpr double kRoundOff = 1e-9;

using Rows = std::vector<std::size_t>;

Eigen::Matrix3Xd placesOf(const BubbleStore& bubbles, const Rows& rows) {
  Eigen::Matrix3Xd at(3, static_cast<Eigen::Index>(rows.size()));
  for (Eigen::Index n = 0; n < at.cols(); ++n) at.col(n) = bubbles.position[rows[n]];
  return at;
}

/// Depth of a bubble's centre below what is allowed [m]; positive if it is too deep.
double excessDepth(double psi, double radius) { return -psi - kDeepestInSolid * radius; }

/// Moves `rows`, which are too deep, outwards and finds their psi anew.
void moveOut(const LiquidSampler& liquid, const Rows& rows, BubbleStore& bubbles, Eigen::VectorXd& psi) {
  const Eigen::Matrix3Xd at = placesOf(bubbles, rows);
  Eigen::Matrix3Xd away(3, at.cols()), solid(3, at.cols());
  liquid.gradPsi(at, away);
  liquid.solidVelocity(at, solid);
  for (Eigen::Index n = 0; n < at.cols(); ++n) {
    const std::size_t i = rows[n];
    const Eigen::Vector3d out = away.col(n).normalized();  // 0 stays 0: no way out is known
    bubbles.position[i] += excessDepth(psi[static_cast<Eigen::Index>(i)], bubbles.radius[i]) * out;
    const double inward = std::min(0.0, out.dot(bubbles.velocity[i] - solid.col(n)));
    bubbles.velocity[i] -= inward * out;
  }
  Eigen::VectorXd there(at.cols());
  liquid.psi(placesOf(bubbles, rows), there);
  for (Eigen::Index n = 0; n < at.cols(); ++n) psi[static_cast<Eigen::Index>(rows[n])] = there[n];
}

}  // namespace

std::size_t keepOutOfSolids(const LiquidSampler& liquid, BubbleStore& bubbles, Eigen::VectorXd& psi) {
  psi.resize(static_cast<Eigen::Index>(bubbles.size()));
  if (bubbles.size() == 0) return 0;
  liquid.psi(bubbles.positions(), psi);
  const auto isDeeper = [&](std::size_t i, double tolerance) {
    const double r = bubbles.radius[i];
    return excessDepth(psi[static_cast<Eigen::Index>(i)], r) > tolerance * r;
  };
  Rows rows;
  listIndices(
      bubbles.size(), [&](std::size_t i) { return isDeeper(i, 0); }, rows);
  const std::size_t moved = rows.size();
  for (int round = 0; round < kRounds && !rows.empty(); ++round) {
    moveOut(liquid, rows, bubbles, psi);
    std::erase_if(rows, [&](std::size_t i) { return !isDeeper(i, kRoundOff); });
  }
  return moved;
}

}  // namespace spume::foam
