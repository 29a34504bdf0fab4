#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace spume::foam {

/// Three numbers and a fourth, in single precision: a register of the narrowest machine, half of one of wider
/// ones. Vectors of a sweep have 0 as their fourth.
using Quad [[gnu::vector_size(4 * sizeof(float))]] = float;

/// The same in double precision.
using DoubleQuad [[gnu::vector_size(4 * sizeof(double))]] = double;

/// As many quads side by side as a sweep takes at a time: what one register holds, but two at most. With the
/// four of AVX-512 rows of five or six couplings leave a third of the work idle (measured: 5 % slower).
#if defined(__AVX__)
inline constexpr std::size_t kQuads = 2;
#else
inline constexpr std::size_t kQuads = 1;
#endif
using QuadLanes [[gnu::vector_size(kQuads * sizeof(Quad))]] = float;

inline Quad loadQuad(const float* from) {
  Quad quad;
  std::memcpy(&quad, from, sizeof quad);
  return quad;
}

inline Quad loadQuad(const Eigen::Vector4f& from) { return loadQuad(from.data()); }

inline Eigen::Vector4f toVector(const Quad& quad) {
  Eigen::Vector4f to;
  std::memcpy(to.data(), &quad, sizeof quad);
  return to;
}

/// Adds in double precision. By reference: without AVX functions do not return vectors of this size.
inline void addTo(DoubleQuad& sum, const Quad& x) { sum += __builtin_convertvector(x, DoubleQuad); }

/// In double precision.
inline void widen(const Eigen::Vector4f& from, DoubleQuad& to) {
  to = __builtin_convertvector(loadQuad(from), DoubleQuad);
}

/// kQuads quads that lie one after the other.
inline QuadLanes loadQuads(const Eigen::Vector4f* from) {
  QuadLanes lanes;
  std::memcpy(&lanes, from, sizeof lanes);
  return lanes;
}

/// The quads of `list` at place[0] .. place[kQuads - 1].
inline QuadLanes gatherQuads(const Eigen::Vector4f* list, const std::int32_t* place) {
  const auto at = [&](std::size_t k) { return loadQuad(list[place[k]]); };
#if defined(__AVX__)
  return __builtin_shufflevector(at(0), at(1), 0, 1, 2, 3, 4, 5, 6, 7);
#else
  return at(0);
#endif
}

/// The first `count` quads of a register as they are, 0 for the others.
inline QuadLanes firstQuads(const QuadLanes& x, std::int32_t count) {
  using Bits [[gnu::vector_size(sizeof(QuadLanes))]] = std::int32_t;
  Bits quad;
  for (std::size_t k = 0; k < 4 * kQuads; ++k) quad[k] = static_cast<std::int32_t>(k / 4);
  return reinterpret_cast<QuadLanes>(reinterpret_cast<Bits>(x) & (quad < count));
}

/// Within each quad: the sum of its numbers, four times; its fourth number, four times.
inline QuadLanes sumsOf(QuadLanes x) {
#if defined(__AVX__)
  x += __builtin_shufflevector(x, x, 1, 0, 3, 2, 5, 4, 7, 6);
  return x + __builtin_shufflevector(x, x, 2, 3, 0, 1, 6, 7, 4, 5);
#else
  x += __builtin_shufflevector(x, x, 1, 0, 3, 2);
  return x + __builtin_shufflevector(x, x, 2, 3, 0, 1);
#endif
}

inline QuadLanes fourthsOf(const QuadLanes& x) {
#if defined(__AVX__)
  return __builtin_shufflevector(x, x, 3, 3, 3, 3, 7, 7, 7, 7);
#else
  return __builtin_shufflevector(x, x, 3, 3, 3, 3);
#endif
}

/// The quads of a register added up.
inline Quad joinQuads(const QuadLanes& x) {
#if defined(__AVX__)
  return __builtin_shufflevector(x, x, 0, 1, 2, 3) + __builtin_shufflevector(x, x, 4, 5, 6, 7);
#else
  return x;
#endif
}

}  // namespace spume::foam
