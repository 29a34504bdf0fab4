#include "foam/wall_limit.h"

#include <algorithm>
#include <vector>

namespace spume::foam {
namespace {

/// Rows of the bubbles that are too deep.
std::vector<std::size_t> tooDeep(const Eigen::VectorXd& psi, const BubbleStore& bubbles) {
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < bubbles.size(); ++i)
    if (psi[static_cast<Eigen::Index>(i)] < -kDeepestInSolid * bubbles.radius[i]) rows.push_back(i);
  return rows;
}

}  // namespace

std::size_t keepOutOfSolids(const LiquidSampler& liquid, BubbleStore& bubbles) {
  if (bubbles.size() == 0) return 0;
  Eigen::VectorXd psi(static_cast<Eigen::Index>(bubbles.size()));
  liquid.psi(bubbles.positions(), psi);
  const std::vector<std::size_t> rows = tooDeep(psi, bubbles);
  if (rows.empty()) return 0;
  Eigen::Matrix3Xd at(3, static_cast<Eigen::Index>(rows.size()));
  for (Eigen::Index n = 0; n < at.cols(); ++n) at.col(n) = bubbles.position[rows[n]];
  Eigen::Matrix3Xd away(3, at.cols()), solid(3, at.cols());
  liquid.gradPsi(at, away);
  liquid.solidVelocity(at, solid);
  for (Eigen::Index n = 0; n < at.cols(); ++n) {
    const std::size_t i = rows[n];
    const Eigen::Vector3d out = away.col(n).normalized();  // 0 stays 0: no way out is known
    bubbles.position[i] -= (psi[static_cast<Eigen::Index>(i)] + kDeepestInSolid * bubbles.radius[i]) * out;
    const double inward = std::min(0.0, out.dot(bubbles.velocity[i] - solid.col(n)));
    bubbles.velocity[i] -= inward * out;
  }
  return rows.size();
}

}  // namespace spume::foam
