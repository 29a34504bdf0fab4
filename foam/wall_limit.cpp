#include "foam/wall_limit.h"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

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

/// Moves those of `rows` that are more than `tolerance` [r] too deep outwards, keeps them in `rows` and drops
/// the others.
void moveOut(const LiquidSampler& liquid, double tolerance, Rows& rows, BubbleStore& bubbles) {
  Eigen::VectorXd psi(static_cast<Eigen::Index>(rows.size()));
  liquid.psi(placesOf(bubbles, rows), psi);
  Rows deep;
  std::vector<double> excess;
  for (Eigen::Index n = 0; n < psi.size(); ++n)
    if (const double by = excessDepth(psi[n], bubbles.radius[rows[n]]);
        by > tolerance * bubbles.radius[rows[n]])
      deep.push_back(rows[n]), excess.push_back(by);
  rows = std::move(deep);
  if (rows.empty()) return;
  const Eigen::Matrix3Xd at = placesOf(bubbles, rows);
  Eigen::Matrix3Xd away(3, at.cols()), solid(3, at.cols());
  liquid.gradPsi(at, away);
  liquid.solidVelocity(at, solid);
  for (Eigen::Index n = 0; n < at.cols(); ++n) {
    const std::size_t i = rows[n];
    const Eigen::Vector3d out = away.col(n).normalized();  // 0 stays 0: no way out is known
    bubbles.position[i] += excess[n] * out;
    const double inward = std::min(0.0, out.dot(bubbles.velocity[i] - solid.col(n)));
    bubbles.velocity[i] -= inward * out;
  }
}

}  // namespace

std::size_t keepOutOfSolids(const LiquidSampler& liquid, BubbleStore& bubbles) {
  Rows rows(bubbles.size());
  std::iota(rows.begin(), rows.end(), std::size_t{0});
  std::size_t moved = 0;
  for (int round = 0; round < kRounds && !rows.empty(); ++round) {
    moveOut(liquid, round == 0 ? 0 : kRoundOff, rows, bubbles);
    if (round == 0) moved = rows.size();
  }
  return moved;
}

}  // namespace spume::foam
