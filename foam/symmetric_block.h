#pragma once

#include <Eigen/Core>

namespace spume::foam {

/// A symmetric 3 x 3 matrix by its six numbers.
struct SymmetricBlock {
  double xx, yy, zz, xy, xz, yz;

  SymmetricBlock() = default;
  explicit SymmetricBlock(const Eigen::Matrix3d& m)
      : xx(m(0, 0)), yy(m(1, 1)), zz(m(2, 2)), xy(m(0, 1)), xz(m(0, 2)), yz(m(1, 2)) {}

  Eigen::Matrix3d matrix() const {
    Eigen::Matrix3d m;
    m << xx, xy, xz, xy, yy, yz, xz, yz, zz;
    return m;
  }
  /// Acts on the first three numbers; the last of the result is 0.
  Eigen::Vector4d times(const Eigen::Vector4d& v) const {
    return {xx * v.x() + xy * v.y() + xz * v.z(), xy * v.x() + yy * v.y() + yz * v.z(),
            xz * v.x() + yz * v.y() + zz * v.z(), 0};
  }
};

}  // namespace spume::foam
