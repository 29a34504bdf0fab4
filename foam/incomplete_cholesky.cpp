#include "foam/incomplete_cholesky.h"

#include <Eigen/LU>

#include "foam/factor_inverse.h"
#include "foam/parallel.h"

namespace spume::foam {
void IncompleteCholesky::factor(Crew& crew, const SweptSystem& a) {
  scale.resize(a.size()), excess.resize(a.size()), inverse_.resize(a.size());
  const auto behind = static_cast<std::int32_t>(a.size()) + 1;
  sweepForth(crew, a, [&](std::size_t, std::size_t k) {
    SymmetricSum d(a.diagonal[k]);
    for (std::int32_t e = a.row[k].behind; e < a.row[k].beyond; ++e)
      d.subtractSandwich(a.known.block[e], inverse_[a.known.other[e] - behind]);
    setPivot(a, k, d.matrix());
  });
}

void IncompleteCholesky::refresh(const SweptSystem& a, const std::vector<SweptSystem::Growth>& rows) {
  forEachIndex(rows.size(), [&](std::size_t r) {
    const std::int32_t k = rows[r].row;
    setPivot(a, k, inverse_[k].matrix().inverse() + rows[r].by);
  });
}

/// Where single precision has taken more from D than there was, beside links 1e7 times stiffer than the row's
/// own block, the diagonal does instead: any positive definite D makes a factor.
void IncompleteCholesky::setPivot(const SweptSystem& a, std::size_t k, const Eigen::Matrix3d& d) {
  Eigen::Matrix3d g;
  if (!invertFactor(d, g)) invertFactor(a.diagonal[k], g);
  scale[k] = TriangularBlock(g);
  g = scale[k].matrix();
  inverse_[k] = SymmetricSum(g.transpose() * g);
  excess[k] = SymmetricBlock(g * a.diagonal[k] * g.transpose() - 2 * Eigen::Matrix3d::Identity());
}

}  // namespace spume::foam
