#pragma once

#include <Eigen/Core>
#include <cmath>

namespace spume::foam {

/// The inverse of the lower triangular L with L L^T = d, into `g`; false where d is not positive definite.
inline bool invertFactor(const Eigen::Matrix3d& d, Eigen::Matrix3d& g) {
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

}  // namespace spume::foam
