#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <bit>
#include <cstdint>

#include "fluid/dense_field.h"

namespace spume::fluid {

/// Read-only view of a dense field for loops that sample it at many points. Built once per loop: plain
/// numbers only, so that a loop over points vectorises into gathers.
struct FieldView {
  const float* corner;  ///< value at index (-kGhost, -kGhost, -kGhost)
  int strideI, strideJ;
  float highI, highJ, highK;  ///< largest cell base along each axis, counted from `corner`

  explicit FieldView(const DenseField<float>& field)
      : corner(field.data()),
        strideI(static_cast<int>(field.stride(0))),
        strideJ(static_cast<int>(field.stride(1))),
        highI(static_cast<float>(field.size().x() + 2 * kGhost - 1)),
        highJ(static_cast<float>(field.size().y() + 2 * kGhost - 1)),
        highK(static_cast<float>(field.size().z() + 2 * kGhost - 1)) {}
};

/// A sampling point split into the offset of its cell base and the three fractions in [0, 1].
struct CellBase {
  int offset;
  float fx, fy, fz;
};

/// Splits a point in index units (the value with index i lives at i), clamped to the window with its ghosts.
inline CellBase cellBase(const FieldView& f, float x, float y, float z) {
  const float xs = std::min(std::max(x + kGhost, 0.0f), f.highI);
  const float ys = std::min(std::max(y + kGhost, 0.0f), f.highJ);
  const float zs = std::min(std::max(z + kGhost, 0.0f), f.highK);
  const int i = static_cast<int>(std::min(xs, f.highI - 1));
  const int j = static_cast<int>(std::min(ys, f.highJ - 1));
  const int k = static_cast<int>(std::min(zs, f.highK - 1));
  return {i * f.strideI + j * f.strideJ + k, xs - static_cast<float>(i), ys - static_cast<float>(j),
          zs - static_cast<float>(k)};
}

/// The same for a point that lies within the window and less than kGhost cells outside its low faces, one
/// less outside its high ones: no clamps, for the inner loops.
inline CellBase innerCellBase(const FieldView& f, float x, float y, float z) {
  const float xs = x + kGhost, ys = y + kGhost, zs = z + kGhost;
  const int i = static_cast<int>(xs), j = static_cast<int>(ys), k = static_cast<int>(zs);
  return {i * f.strideI + j * f.strideJ + k, xs - static_cast<float>(i), ys - static_cast<float>(j),
          zs - static_cast<float>(k)};
}

inline float lerp(float a, float b, float t) { return a + t * (b - a); }

// Without std::min's references, so that loops vectorise.
inline float smaller(float a, float b) { return a < b ? a : b; }
inline float larger(float a, float b) { return a > b ? a : b; }

/// `value` kept within [0, limit]; 0 if it is not a number.
inline float keptInside(float value, float limit) { return smaller(larger(value, 0), limit); }

/// Two neighbours along z.
struct Neighbours {
  float low, high;
};
/// Reads p[o] and p[o + 1] at once: loops over points gather half as many words, in three quarters of the
/// time.
inline Neighbours loadNeighbours(const float* p, int o) {
  static_assert(std::endian::native == std::endian::little, "the lower neighbour is the lower half");
  using Both [[gnu::aligned(4), gnu::may_alias]] = std::uint64_t;
  const std::uint64_t both = *reinterpret_cast<const Both*>(p + o);
  return {std::bit_cast<float>(static_cast<std::uint32_t>(both)),
          std::bit_cast<float>(static_cast<std::uint32_t>(both >> 32))};
}
inline float lerp(Neighbours v, float t) { return lerp(v.low, v.high, t); }

/// Trilinear value in a cube.
inline float interpolate(const FieldView& f, const CellBase& b) {
  const float* p = f.corner;
  const int o = b.offset, si = f.strideI, sj = f.strideJ;
  const float c00 = lerp(loadNeighbours(p, o), b.fz), c01 = lerp(loadNeighbours(p, o + sj), b.fz);
  const float c10 = lerp(loadNeighbours(p, o + si), b.fz), c11 = lerp(loadNeighbours(p, o + si + sj), b.fz);
  return lerp(lerp(c00, c01, b.fy), lerp(c10, c11, b.fy), b.fx);
}

/// Trilinear value at a point in index units.
inline float sampleIndex(const FieldView& f, float x, float y, float z) {
  return interpolate(f, cellBase(f, x, y, z));
}
/// The same within the limits of innerCellBase.
inline float sampleInner(const FieldView& f, float x, float y, float z) {
  return interpolate(f, innerCellBase(f, x, y, z));
}

/// Trilinear value of a cell-centred field at a position in cell units.
inline float sampleCentred(const FieldView& f, float x, float y, float z) {
  return sampleIndex(f, x - 0.5f, y - 0.5f, z - 0.5f);
}

/// Trilinear value of a cell-centred field and its gradient per cell at a position in cell units.
struct ValueAndGradient {
  float value, gx, gy, gz;
};
inline ValueAndGradient interpolateGradient(const FieldView& f, const CellBase& b) {
  const float* p = f.corner;
  const int o = b.offset, si = f.strideI, sj = f.strideJ;
  const auto [v000, v001] = loadNeighbours(p, o);
  const auto [v010, v011] = loadNeighbours(p, o + sj);
  const auto [v100, v101] = loadNeighbours(p, o + si);
  const auto [v110, v111] = loadNeighbours(p, o + si + sj);
  const float c00 = lerp(v000, v001, b.fz), c01 = lerp(v010, v011, b.fz);
  const float c10 = lerp(v100, v101, b.fz), c11 = lerp(v110, v111, b.fz);
  const float c0 = lerp(c00, c01, b.fy), c1 = lerp(c10, c11, b.fy);
  const float d0 = lerp(v001 - v000, v011 - v010, b.fy), d1 = lerp(v101 - v100, v111 - v110, b.fy);
  return {lerp(c0, c1, b.fx), c1 - c0, lerp(c01 - c00, c11 - c10, b.fx), lerp(d0, d1, b.fx)};
}

inline ValueAndGradient sampleCentredGradient(const FieldView& f, float x, float y, float z) {
  return interpolateGradient(f, cellBase(f, x - 0.5f, y - 0.5f, z - 0.5f));
}

/// View of a staggered velocity.
struct MacView {
  FieldView u, v, w;
  explicit MacView(const MacVelocity& velocity) : u(velocity[0]), v(velocity[1]), w(velocity[2]) {}
};

struct Velocity3f {
  float x, y, z;
};

/// Velocity [m/s] at a position in cell units, each component trilinear on its own faces.
inline Velocity3f sampleVelocity(const MacView& m, float x, float y, float z) {
  return {sampleIndex(m.u, x, y - 0.5f, z - 0.5f), sampleIndex(m.v, x - 0.5f, y, z - 0.5f),
          sampleIndex(m.w, x - 0.5f, y - 0.5f, z)};
}
/// The same at a position inside the grid or less than 3 cells outside.
inline Velocity3f sampleInnerVelocity(const MacView& m, float x, float y, float z) {
  return {sampleInner(m.u, x, y - 0.5f, z - 0.5f), sampleInner(m.v, x - 0.5f, y, z - 0.5f),
          sampleInner(m.w, x - 0.5f, y - 0.5f, z)};
}

}  // namespace spume::fluid
