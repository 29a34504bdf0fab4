#pragma once

#include <Eigen/Core>

namespace spume::foam {

/// A symmetric 3 x 3 matrix by its six numbers, laid out so that a product is three multiplications of whole
/// registers.
struct SymmetricBlock {
  Eigen::Vector4d straight;  ///< xx, yy, zz, 0
  Eigen::Vector4d crossed;   ///< xy, xz, yz, 0

  SymmetricBlock() = default;
  explicit SymmetricBlock(const Eigen::Matrix3d& m)
      : straight(m(0, 0), m(1, 1), m(2, 2), 0), crossed(m(0, 1), m(0, 2), m(1, 2), 0) {}

  Eigen::Matrix3d matrix() const {
    Eigen::Matrix3d m;
    m << straight[0], crossed[0], crossed[1], crossed[0], straight[1], crossed[2], crossed[1], crossed[2],
        straight[2];
    return m;
  }
  /// Acts on the first three numbers, the last may be any finite one; the last of the result is 0.
  Eigen::Vector4d times(const Eigen::Vector4d& v) const {
    using Four [[gnu::vector_size(4 * sizeof(double))]] = double;
    const auto load = [](const Eigen::Vector4d& from) {
      Four to;
      __builtin_memcpy(&to, from.data(), sizeof to);
      return to;
    };
    const Four s = load(straight), c = load(crossed), x = load(v);
    const Four product =
        s * x + __builtin_shufflevector(c, c, 0, 0, 1, 3) * __builtin_shufflevector(x, x, 1, 0, 0, 3) +
        __builtin_shufflevector(c, c, 1, 2, 2, 3) * __builtin_shufflevector(x, x, 2, 2, 1, 3);
    Eigen::Vector4d out;
    __builtin_memcpy(out.data(), &product, sizeof product);
    return out;
  }
};

}  // namespace spume::foam
