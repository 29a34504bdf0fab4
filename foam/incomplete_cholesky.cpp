#include "foam/incomplete_cholesky.h"

#include <Eigen/Cholesky>

#include "foam/parallel.h"

namespace spume::foam {
namespace {

/// B M B with B = a a^T + c I.
Eigen::Matrix3d sandwich(const SweptSystem::Coupling& coupling, const Eigen::Matrix3d& m) {
  const Eigen::Vector3d a = coupling.head<3>().cast<double>(), ma = m * a;
  const double c = coupling.w();
  const Eigen::Matrix3d mixed = a * ma.transpose();
  return a.dot(ma) * a * a.transpose() + c * (mixed + mixed.transpose()) + c * c * m;
}

/// The inverse of a lower triangular matrix.
Eigen::Matrix3d inverseOf(const Eigen::Matrix3d& l) {
  Eigen::Matrix3d g = Eigen::Matrix3d::Zero();
  for (int k = 0; k < 3; ++k) g(k, k) = 1 / l(k, k);
  g(1, 0) = -l(1, 0) * g(0, 0) * g(1, 1), g(2, 1) = -l(2, 1) * g(1, 1) * g(2, 2);
  g(2, 0) = -(l(2, 0) * g(0, 0) + l(2, 1) * g(1, 0)) * g(2, 2);
  return g;
}

}  // namespace

void IncompleteCholesky::factor(Crew& crew, const SweptSystem& a) {
  scale.resize(a.size()), excess.resize(a.size()), pivot_.resize(a.size()), diagonal_.resize(a.size());
  inverse_.resize(a.size());
  const auto behind = static_cast<std::int32_t>(a.size()) + 1;
  sweepForth(crew, a, [&](std::size_t, std::size_t k) {
    Eigen::Matrix3d d = a.diagonal[k];
    for (std::int32_t e = a.row[k].behind; e < a.row[k].beyond; ++e)
      d -= sandwich(a.known.block[e], inverse_[a.known.other[e] - behind]);
    setPivot(a, k, d);
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
  Eigen::LLT<Eigen::Matrix3d> cholesky(d);
  if (cholesky.info() != Eigen::Success) cholesky.compute(pivot_[k] = a.diagonal[k]);
  scale[k] = TriangularBlock(inverseOf(cholesky.matrixL()));
  const Eigen::Matrix3d g = scale[k].matrix();
  inverse_[k].noalias() = g.transpose() * g;
  excess[k] = SymmetricBlock(g * a.diagonal[k] * g.transpose() - 2 * Eigen::Matrix3d::Identity());
}

}  // namespace spume::foam
