#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace spume::foam {

/// Three numbers and a fourth, in single precision: half a register of the narrowest machine, a quarter of
/// the widest. Vectors of a sweep have 0 as their fourth.
using Quad [[gnu::vector_size(4 * sizeof(float))]] = float;

/// The same in double precision.
using DoubleQuad [[gnu::vector_size(4 * sizeof(double))]] = double;

/// As many quads side by side as one register of the instruction set the library is built for holds.
#if defined(__AVX512F__)
inline constexpr std::size_t kQuads = 4;
#elif defined(__AVX__)
inline constexpr std::size_t kQuads = 2;
#else
inline constexpr std::size_t kQuads = 1;
#endif
using QuadLanes [[gnu::vector_size(kQuads * sizeof(Quad))]] = float;

inline Quad loadQuad(const Eigen::Vector4f& from) {
  Quad quad;
  std::memcpy(&quad, from.data(), sizeof quad);
  return quad;
}

inline Eigen::Vector4f toVector(const Quad& quad) {
  Eigen::Vector4f to;
  std::memcpy(to.data(), &quad, sizeof quad);
  return to;
}

inline DoubleQuad widened(const Quad& x) { return __builtin_convertvector(x, DoubleQuad); }

/// kQuads quads that lie one after the other.
inline QuadLanes loadQuads(const Eigen::Vector4f* from) {
  QuadLanes lanes;
  std::memcpy(&lanes, from, sizeof lanes);
  return lanes;
}

/// The quads of `list` at place[0] .. place[kQuads - 1].
inline QuadLanes gatherQuads(const Eigen::Vector4f* list, const std::int32_t* place) {
  const auto at = [&](std::size_t k) { return loadQuad(list[place[k]]); };
#if defined(__AVX512F__)
  using TwoQuads [[gnu::vector_size(2 * sizeof(Quad))]] = float;
  const TwoQuads low = __builtin_shufflevector(at(0), at(1), 0, 1, 2, 3, 4, 5, 6, 7);
  const TwoQuads high = __builtin_shufflevector(at(2), at(3), 0, 1, 2, 3, 4, 5, 6, 7);
  return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
#elif defined(__AVX__)
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
#if defined(__AVX512F__)
  x += __builtin_shufflevector(x, x, 1, 0, 3, 2, 5, 4, 7, 6, 9, 8, 11, 10, 13, 12, 15, 14);
  return x + __builtin_shufflevector(x, x, 2, 3, 0, 1, 6, 7, 4, 5, 10, 11, 8, 9, 14, 15, 12, 13);
#elif defined(__AVX__)
  x += __builtin_shufflevector(x, x, 1, 0, 3, 2, 5, 4, 7, 6);
  return x + __builtin_shufflevector(x, x, 2, 3, 0, 1, 6, 7, 4, 5);
#else
  x += __builtin_shufflevector(x, x, 1, 0, 3, 2);
  return x + __builtin_shufflevector(x, x, 2, 3, 0, 1);
#endif
}

inline QuadLanes fourthsOf(const QuadLanes& x) {
#if defined(__AVX512F__)
  return __builtin_shufflevector(x, x, 3, 3, 3, 3, 7, 7, 7, 7, 11, 11, 11, 11, 15, 15, 15, 15);
#elif defined(__AVX__)
  return __builtin_shufflevector(x, x, 3, 3, 3, 3, 7, 7, 7, 7);
#else
  return __builtin_shufflevector(x, x, 3, 3, 3, 3);
#endif
}

/// The quads of a register added up.
inline Quad joinQuads(const QuadLanes& x) {
#if defined(__AVX512F__)
  using TwoQuads [[gnu::vector_size(2 * sizeof(Quad))]] = float;
  const TwoQuads two = __builtin_shufflevector(x, x, 0, 1, 2, 3, 4, 5, 6, 7) +
                       __builtin_shufflevector(x, x, 8, 9, 10, 11, 12, 13, 14, 15);
  return __builtin_shufflevector(two, two, 0, 1, 2, 3) + __builtin_shufflevector(two, two, 4, 5, 6, 7);
#elif defined(__AVX__)
  return __builtin_shufflevector(x, x, 0, 1, 2, 3) + __builtin_shufflevector(x, x, 4, 5, 6, 7);
#else
  return x;
#endif
}

}  // namespace spume::foam
