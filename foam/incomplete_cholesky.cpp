#include "foam/incomplete_cholesky.h"

#include <Eigen/LU>

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

}  // namespace

void IncompleteCholesky::factor(const SweptSystem& a) {
  pivot.resize(a.size()), inverse.resize(a.size()), excess.resize(a.size());
  const auto behind = static_cast<std::int32_t>(a.size()) + 1;
  sweepForth(a, [&](std::size_t, std::size_t k) {
    Eigen::Matrix3d d = a.diagonal[k].matrix();
    for (std::int32_t e = a.row[k].behind; e < a.row[k].beyond; ++e)
      d -= sandwich(a.coupling[e], inverse[a.other[e] - behind].matrix());
    setPivot(a, k, d);
  });
}

void IncompleteCholesky::refresh(const SweptSystem& a) {
  forEachIndex(a.size(), [&](std::size_t k) {
    if (!a.changed[k]) return;
    const Eigen::Matrix3d d = pivot[k].matrix(), before = excess[k].matrix() + 2 * d;
    setPivot(a, k, d + a.diagonal[k].matrix() - before);
  });
}

void IncompleteCholesky::setPivot(const SweptSystem& a, std::size_t k, const Eigen::Matrix3d& d) {
  pivot[k] = SymmetricBlock(d);
  inverse[k] = SymmetricBlock(d.inverse());
  excess[k] = SymmetricBlock(a.diagonal[k].matrix() - 2 * d);
}

}  // namespace spume::foam
