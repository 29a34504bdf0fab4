#include "foam/incomplete_cholesky.h"

#include <cmath>

#include "foam/parallel.h"

namespace spume::foam {
namespace {

/// The inverse of the lower triangular L with L L^T = d, into `g`; false where d is not positive definite.
bool invertFactor(const Eigen::Matrix3d& d, Eigen::Matrix3d& g) {
  const double xx = d(0, 0);
  g.setZero();
  g(0, 0) = 1 / std::sqrt(xx);
  const double yx = d(1, 0) * g(0, 0), zx = d(2, 0) * g(0, 0), yy = d(1, 1) - yx * yx;
  g(1, 1) = 1 / std::sqrt(yy);
  const double zy = (d(2, 1) - zx * yx) * g(1, 1), zz = d(2, 2) - zx * zx - zy * zy;
  g(2, 2) = 1 / std::sqrt(zz);
  g(1, 0) = -yx * g(0, 0) * g(1, 1), g(2, 1) = -zy * g(1, 1) * g(2, 2);
  g(2, 0) = -(zx * g(0, 0) + zy * g(1, 0)) * g(2, 2);
  return xx > 0 && yy > 0 && zz > 0;
}

}  // namespace

void IncompleteCholesky::factor(Crew& crew, const SweptSystem& a) {
  scale.resize(a.size()), excess.resize(a.size()), pivot_.resize(a.size()), diagonal_.resize(a.size());
  inverse_.resize(a.size());
  const auto behind = static_cast<std::int32_t>(a.size()) + 1;
  sweepForth(crew, a, [&](std::size_t, std::size_t k) {
    SymmetricSum d(a.diagonal[k]);
    for (std::int32_t e = a.row[k].behind; e < a.row[k].beyond; ++e)
      d.subtractSandwich(a.known.block[e], inverse_[a.known.other[e] - behind]);
    setPivot(a, k, d.matrix());
  });
}

void IncompleteCholesky::refresh(const SweptSystem& a, const std::vector<std::int32_t>& rows) {
  forEachIndex(rows.size(), [&](std::size_t r) {
    const std::int32_t k = rows[r];
    setPivot(a, k, pivot_[k] + a.diagonal[k] - diagonal_[k]);
  });
}

/// Where single precision has taken more from D than there was, beside links 1e7 times stiffer than the row's
/// own block, the diagonal does instead: any positive definite D makes a factor.
void IncompleteCholesky::setPivot(const SweptSystem& a, std::size_t k, const Eigen::Matrix3d& d) {
  pivot_[k] = d, diagonal_[k] = a.diagonal[k];
  Eigen::Matrix3d g;
  if (!invertFactor(d, g)) invertFactor(pivot_[k] = a.diagonal[k], g);
  scale[k] = TriangularBlock(g);
  g = scale[k].matrix();
  inverse_[k] = SymmetricSum(g.transpose() * g);
  excess[k] = SymmetricBlock(g * a.diagonal[k] * g.transpose() - 2 * Eigen::Matrix3d::Identity());
}

}  // namespace spume::foam
