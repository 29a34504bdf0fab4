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
  forEachBlock(a, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
      Eigen::Matrix3d d = a.diagonal[k].matrix();
      for (std::int32_t e = a.row[k].start; e < a.row[k].after; ++e)
        d -= sandwich(a.coupling[e], inverse[a.other[e]].matrix());
      pivot[k] = SymmetricBlock(d);
      inverse[k] = SymmetricBlock(d.inverse());
      excess[k] = SymmetricBlock(a.diagonal[k].matrix() - 2 * d);
    }
  });
}

}  // namespace spume::foam
