#pragma once

#include <cstdint>

namespace spume::fluid {

/// Stateless random numbers: the same (seed, id, purpose) gives the same bits on any number of threads and in
/// any order of calls. The mixer is SplitMix64's finaliser applied to each word in turn.
class CounterRandom {
 public:
  CounterRandom(std::uint64_t seed, std::uint64_t id, std::uint64_t purpose)
      : state_(mix(mix(mix(seed) ^ id) ^ purpose)) {}

  std::uint64_t bits() { return mix(state_ += 0x9e3779b97f4a7c15ull); }
  /// Uniform in [0, 1).
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1.0p-53; }

 private:
  static std::uint64_t mix(std::uint64_t z) {
    z += 0x9e3779b97f4a7c15ull;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    return z ^ (z >> 31);
  }
  std::uint64_t state_;
};

}  // namespace spume::fluid
