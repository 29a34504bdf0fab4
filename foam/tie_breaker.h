#pragma once

#include <cstdint>

#include "foam/counter_random.h"

namespace spume::foam {

/// Relative size of the radius jitter that decides exact ties (lattices, cocircular or coincident centres).
/// Large enough to stand clear of round-off (1e-12 is not), small enough that correcting volumes back to
/// first order leaves an error of its square (performance, "Traps").
inline constexpr double kTieJitter = 1e-9;

/// The radius [m] with which both geometry engines decide contacts for bubble `id`.
inline double tieBrokenRadius(double radius, std::uint64_t id) {
  constexpr std::uint64_t kPurpose = 0x7469652d627265ull;
  return radius * (1 + kTieJitter * (2 * CounterRandom(0, id, kPurpose).uniform() - 1));
}

}  // namespace spume::foam
