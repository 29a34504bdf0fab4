#pragma once

namespace spume::coupling {

/// The instruction set this program is compiled for. Programs of different ones agree to round-off, not to
/// the bit, so a run stays with the one it began with (design, 7.3).
inline constexpr const char* kSimdPath =
#if defined(__AVX512F__)
    "avx512";
#elif defined(__AVX2__) && defined(__FMA__)
    "avx2";
#elif defined(__AVX__)
    "avx";
#else
    "portable";
#endif

}  // namespace spume::coupling
