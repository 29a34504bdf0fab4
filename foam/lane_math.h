#pragma once

#if defined(__SSE2__)
#include <immintrin.h>
#endif

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <numbers>

namespace spume::foam {

/// Doubles worked on at once: one register of the instruction set the library is built for.
#if defined(__AVX512F__)
inline constexpr std::size_t kLanes = 8;
#elif defined(__AVX__)
inline constexpr std::size_t kLanes = 4;
#else
inline constexpr std::size_t kLanes = 2;
#endif

/// A block of kLanes doubles with element-wise arithmetic; a comparison gives LaneMask, which ?: takes
/// element by element. Data comes in whole blocks padded with neutral elements, so every element goes through
/// the same instructions.
using Lanes [[gnu::vector_size(kLanes * sizeof(double))]] = double;
using LaneMask [[gnu::vector_size(kLanes * sizeof(double))]] = std::int64_t;

inline constexpr std::size_t paddedToLanes(std::size_t count) {
  return (count + kLanes - 1) / kLanes * kLanes;
}

inline Lanes loadLanes(const double* from) {
  Lanes lanes;
  std::memcpy(&lanes, from, sizeof lanes);
  return lanes;
}

inline void storeLanes(double* to, const Lanes& lanes) { std::memcpy(to, &lanes, sizeof lanes); }

inline Lanes squareRoot(const Lanes& x) {
  Lanes root;
  for (std::size_t k = 0; k < kLanes; ++k) root[k] = std::sqrt(x[k]);
  return root;
}

/// Bit k is set if lane k is.
inline std::uint32_t bitsOf(const LaneMask& mask) {
#if defined(__AVX512DQ__)
  return _mm512_movepi64_mask(reinterpret_cast<__m512i>(mask));
#elif defined(__AVX__) && !defined(__AVX512F__)
  return static_cast<std::uint32_t>(_mm256_movemask_pd(reinterpret_cast<__m256d>(mask)));
#elif defined(__SSE2__) && !defined(__AVX__)
  return static_cast<std::uint32_t>(_mm_movemask_pd(reinterpret_cast<__m128d>(mask)));
#else
  std::uint32_t bits = 0;
  for (std::size_t k = 0; k < kLanes; ++k) bits |= static_cast<std::uint32_t>(mask[k] & (1 << k));
  return bits;
#endif
}

/// The bits of the first `count` lanes.
inline std::uint32_t lanesBelow(std::size_t count) {
  return count < kLanes ? (1u << count) - 1 : (1u << kLanes) - 1;
}

/// Writes those of kLanes values whose bit is set to `to`, closed up, and returns how many; kLanes values
/// may be overwritten there.
inline std::size_t storeSelected(std::uint32_t bits, const Lanes& values, double* to) {
#if defined(__AVX512F__)
  _mm512_storeu_pd(to,
                   _mm512_maskz_compress_pd(static_cast<__mmask8>(bits), reinterpret_cast<__m512d>(values)));
#else
  for (std::uint32_t left = bits; left != 0; left &= left - 1) *to++ = values[std::countr_zero(left)];
#endif
  return static_cast<std::size_t>(std::popcount(bits));
}

inline std::size_t storeSelected(std::uint32_t bits, const std::int32_t* values, std::int32_t* to) {
#if defined(__AVX512VL__)
  const __m256i all = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(values));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to),
                      _mm256_maskz_compress_epi32(static_cast<__mmask8>(bits), all));
#else
  for (std::uint32_t left = bits; left != 0; left &= left - 1) *to++ = values[std::countr_zero(left)];
#endif
  return static_cast<std::size_t>(std::popcount(bits));
}

/// Writes the places of those of kLanes values whose bit is set, of which the first is at place `first`, as
/// storeSelected does.
inline std::size_t storePlaces(std::uint32_t bits, std::int32_t first, std::int32_t* to) {
#if defined(__AVX512VL__)
  const __m256i all = _mm256_add_epi32(_mm256_set1_epi32(first), _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to),
                      _mm256_maskz_compress_epi32(static_cast<__mmask8>(bits), all));
#else
  for (std::uint32_t left = bits; left != 0; left &= left - 1) *to++ = first + std::countr_zero(left);
#endif
  return static_cast<std::size_t>(std::popcount(bits));
}

inline double sumOf(const Lanes& x) {
  double sum = 0;
  for (std::size_t k = 0; k < kLanes; ++k) sum += x[k];
  return sum;
}

/// Angle of the point (x, y), y >= 0, in [0, pi]; 0 at the origin. For double or Lanes; within 2 ulp. Reduces
/// to |z| <= tan(pi/8), where z P(z^2) with P the Chebyshev interpolant of degree 11 of atan(z)/z is exact
/// to 1.3e-18.
template <typename Real>
inline Real upperAngle(const Real& y, const Real& x) {
  constexpr double kTanEighth = 0.41421356237309503, kTiny = 1e-300;
  const Real zero = {}, ax = x < 0 ? -x : x;
  const Real small = y <= ax ? y : ax, large = y <= ax ? ax : y;
  const auto reduce = small > kTanEighth * large;
  const Real top = reduce ? small - large : small, bottom = (reduce ? small + large : large) + kTiny;
  const Real z = top / bottom, u = z * z;
  Real p = zero - 0.017805395704537507381;
  p = p * u + 0.037965256099576568431;
  p = p * u - 0.050351024039430294125;
  p = p * u + 0.058468782857870010961;
  p = p * u - 0.066629518120618369597;
  p = p * u + 0.076920453307659118451;
  p = p * u - 0.090908968090564377814;
  p = p * u + 0.11111110744919395758;
  p = p * u - 0.14285714279250239667;
  p = p * u + 0.19999999999940891408;
  p = p * u - 0.33333333333333121163;
  p = p * u + 1.0;
  const Real steep = z * p + (reduce ? zero + std::numbers::pi / 4 : zero);
  const Real acute = y <= ax ? steep : std::numbers::pi / 2 - steep;
  return x < 0 ? std::numbers::pi - acute : acute;
}

}  // namespace spume::foam
