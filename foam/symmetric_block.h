#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "foam/quad_lanes.h"

namespace spume::foam {

struct SymmetricBlock;

/// A symmetric 3 x 3 matrix in double precision, laid out in the same way to be summed up; fourth numbers
/// have no meaning.
struct SymmetricSum {
  DoubleQuad straight = {}, crossed = {};

  SymmetricSum() = default;
  explicit SymmetricSum(const Eigen::Matrix3d& m)
      : straight{m(0, 0), m(1, 1), m(2, 2), 0}, crossed{m(0, 1), m(0, 2), m(1, 2), 0} {}

  Eigen::Matrix3d matrix() const {
    Eigen::Matrix3d m;
    m << straight[0], crossed[0], crossed[1], crossed[0], straight[1], crossed[2], crossed[1], crossed[2],
        straight[2];
    return m;
  }
  void add(double factor, const SymmetricSum& other) {
    straight += factor * other.straight, crossed += factor * other.crossed;
  }
  /// Adds B = a a^T + c I, given (a, c).
  void add(const Eigen::Vector4f& coupling) {
    DoubleQuad b;
    widen(coupling, b);
    add(b);
  }
  void add(const DoubleQuad& b) {
    straight += b * b + __builtin_shufflevector(b, b, 3, 3, 3, 3);
    crossed += __builtin_shufflevector(b, b, 0, 0, 1, 3) * __builtin_shufflevector(b, b, 1, 2, 2, 3);
  }
  void add(const SymmetricBlock& block);
  /// Takes B M B away: a t^T + t a^T + c^2 M with t = (a . M a) a / 2 + c M a.
  void subtractSandwich(const Eigen::Vector4f& coupling, const SymmetricSum& m) {
    DoubleQuad b;
    widen(coupling, b);
    const DoubleQuad x = __builtin_shufflevector(b, b, 0, 0, 1, 3),
                     y = __builtin_shufflevector(b, b, 1, 2, 2, 3);
    const DoubleQuad image =
        m.straight * b +
        __builtin_shufflevector(m.crossed, m.crossed, 0, 0, 1, 3) *
            __builtin_shufflevector(b, b, 1, 0, 0, 3) +
        __builtin_shufflevector(m.crossed, m.crossed, 1, 2, 2, 3) * __builtin_shufflevector(b, b, 2, 2, 1, 3);
    const DoubleQuad products = b * image;
    const double c = b[3], half = 0.5 * (products[0] + products[1] + products[2]);
    const DoubleQuad t = half * b + c * image;
    straight -= 2 * b * t + c * c * m.straight;
    crossed -= x * __builtin_shufflevector(t, t, 1, 2, 2, 3) + y * __builtin_shufflevector(t, t, 0, 0, 1, 3) +
               c * c * m.crossed;
  }
};

/// A symmetric 3 x 3 matrix by its six numbers, laid out so that a product is three multiplications of whole
/// quads.
struct SymmetricBlock {
  float number[6];  ///< xx, yy, zz, xy, xz, yz

  SymmetricBlock() = default;
  explicit SymmetricBlock(const SymmetricSum& m)
      : number{static_cast<float>(m.straight[0]), static_cast<float>(m.straight[1]),
               static_cast<float>(m.straight[2]), static_cast<float>(m.crossed[0]),
               static_cast<float>(m.crossed[1]),  static_cast<float>(m.crossed[2])} {}
  explicit SymmetricBlock(const Eigen::Matrix3d& m) : SymmetricBlock(SymmetricSum(m)) {}

  /// Acts on the first three numbers of x, whose fourth is 0; the fourth of the result is 0.
  Quad times(const Quad& x) const {
    const Quad s = loadQuad(&number[0]), c = loadQuad(&number[2]);
    return s * x + __builtin_shufflevector(c, c, 1, 1, 2, 3) * __builtin_shufflevector(x, x, 1, 0, 0, 3) +
           __builtin_shufflevector(c, c, 2, 3, 3, 3) * __builtin_shufflevector(x, x, 2, 2, 1, 3);
  }
};

inline void SymmetricSum::add(const SymmetricBlock& block) {
  const float* const of = block.number;
  straight += DoubleQuad{of[0], of[1], of[2], 0}, crossed += DoubleQuad{of[3], of[4], of[5], 0};
}

/// The products of as many blocks as a register holds vectors of, but for those after the first `count`,
/// which give 0.
inline QuadLanes timesQuads(const SymmetricBlock* blocks, std::int32_t count, const QuadLanes& x) {
#if defined(__AVX__)
  const auto two = [&](int from) {
    const Quad first = loadQuad(&blocks[0].number[from]), second = loadQuad(&blocks[1].number[from]);
    return firstQuads(__builtin_shufflevector(first, second, 0, 1, 2, 3, 4, 5, 6, 7), count);
  };
  const QuadLanes s = two(0), c = two(2);
  return s * x +
         __builtin_shufflevector(c, c, 1, 1, 2, 3, 5, 5, 6, 7) *
             __builtin_shufflevector(x, x, 1, 0, 0, 3, 5, 4, 4, 7) +
         __builtin_shufflevector(c, c, 2, 3, 3, 3, 6, 7, 7, 7) *
             __builtin_shufflevector(x, x, 2, 2, 1, 3, 6, 6, 5, 7);
#else
  return count > 0 ? blocks[0].times(x) : QuadLanes{};
#endif
}

/// A lower triangular 3 x 3 matrix by its six numbers; both products are three multiplications of whole
/// quads.
struct TriangularBlock {
  Eigen::Vector4f straight;  ///< xx, yy, zz, 0
  Eigen::Vector4f below;     ///< yx, zy, zx, 0

  TriangularBlock() = default;
  explicit TriangularBlock(const Eigen::Matrix3d& m)
      : straight(Eigen::Vector4d(m(0, 0), m(1, 1), m(2, 2), 0).cast<float>()),
        below(Eigen::Vector4d(m(1, 0), m(2, 1), m(2, 0), 0).cast<float>()) {}

  Eigen::Matrix3d matrix() const {
    const Eigen::Vector4d s = straight.cast<double>(), b = below.cast<double>();
    Eigen::Matrix3d m;
    m << s[0], 0, 0, b[0], s[1], 0, b[2], b[1], s[2];
    return m;
  }
  /// Act on the first three numbers; the fourth must be finite, the fourth of the result is 0.
  Quad times(const Quad& x) const {
    const Quad s = loadQuad(straight), b = loadQuad(below);
    return s * x + __builtin_shufflevector(b, b, 3, 0, 1, 3) * __builtin_shufflevector(x, x, 3, 0, 1, 3) +
           __builtin_shufflevector(b, b, 3, 3, 2, 3) * __builtin_shufflevector(x, x, 3, 3, 0, 3);
  }
  /// The vector that times() takes to x.
  Eigen::Vector3d solve(const Eigen::Vector3d& x) const {
    const Eigen::Vector4d s = straight.cast<double>(), b = below.cast<double>();
    Eigen::Vector3d v;
    v.x() = x.x() / s[0];
    v.y() = (x.y() - b[0] * v.x()) / s[1];
    v.z() = (x.z() - b[2] * v.x() - b[1] * v.y()) / s[2];
    return v;
  }
  Quad transposedTimes(const Quad& x) const {
    const Quad s = loadQuad(straight), b = loadQuad(below);
    return s * x + __builtin_shufflevector(b, b, 0, 1, 3, 3) * __builtin_shufflevector(x, x, 1, 2, 3, 3) +
           __builtin_shufflevector(b, b, 2, 3, 3, 3) * __builtin_shufflevector(x, x, 2, 3, 3, 3);
  }
};

}  // namespace spume::foam
