#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "foam/counter_random.h"

namespace spume::foam {

/// Relative size of the radius jitter that decides exact ties (lattices, cocircular or coincident centres).
/// Large enough to stand clear of round-off (1e-12 is not), small enough that correcting volumes back to
/// first order leaves an error of its square (performance, "Traps").
inline constexpr double kTieJitter = 1e-9;

/// Largest shift of a plane, relative to the smaller radius, for which undoing the jitter is a small change:
/// the error of first order is its square. Only nearly coincident centres exceed it; there the jitter
/// decides, as for any tie.
inline constexpr double kMaxRelativeShift = 1e-5;

/// A ball as both geometry engines see it: with a radius that decides ties, and what undoing that adds.
struct TieBrokenBall {
  double radius;       ///< true radius x (1 + 1e-9 x hash of the id, -1..1) [m]
  double radiusShift;  ///< true radius - radius [m]
  double weightShift;  ///< the same for r^2 [m^2]

  TieBrokenBall() = default;
  TieBrokenBall(double trueRadius, std::uint64_t id) {
    constexpr std::uint64_t kPurpose = 0x7469652d627265ull;
    radius = trueRadius * (1 + kTieJitter * (2 * CounterRandom(0, id, kPurpose).uniform() - 1));
    radiusShift = trueRadius - radius;
    weightShift = radiusShift * (trueRadius + radius);
  }
};

/// Signed distance [m] of the radical plane of two balls d > 0 apart from the centre of a, positive towards
/// b.
inline double radicalHeight(const TieBrokenBall& a, const TieBrokenBall& b, double d) {
  return (d + (a.radius - b.radius) * ((a.radius + b.radius) / d)) / 2;
}

/// What undoing the jitter adds to that height [m].
inline double radicalHeightShift(const TieBrokenBall& a, const TieBrokenBall& b, double d) {
  const double shift = (a.weightShift - b.weightShift) / (2 * d);
  return std::abs(shift) < kMaxRelativeShift * std::min(a.radius, b.radius) ? shift : 0;
}

}  // namespace spume::foam
