#pragma once

#include "foam/overlap_pairs.h"
#include "foam/parallel.h"
#include "tests/support/foam_balls.h"

namespace spume::foam::test {

/// Rest length of Eq. 1 [m]: l^2 = r_i^2 + r_j^2 + (3 lambda - 1) r_i r_j.
inline double restLength(double ri, double rj, double wetness) {
  return std::sqrt(ri * ri + rj * rj + (3 * wetness - 1) * ri * rj);
}

/// Pushes pairs closer than their rest length apart, half each, all at once; walls of a cube of side `side`
/// hold them in.
inline void pushApart(Balls& balls, double wetness, double side, OverlapPairs& near) {
  near.update(balls.position, balls.radius);
  std::vector<Eigen::Vector3d> moved = balls.position;
  forEachIndex(balls.size(), [&](std::size_t s) {
    const int i = near.order()[s];
    for (int slot = near.rowStart()[s]; slot < near.rowStart()[s + 1]; ++slot) {
      const int j = near.order()[near.candidate()[slot]];
      const Eigen::Vector3d apart = balls.position[i] - balls.position[j];
      const double d = apart.norm(), l = restLength(balls.radius[i], balls.radius[j], wetness);
      // A third, not half: about three pushes act on a bubble at once and would overshoot.
      if (d < l && d > 0) moved[i] += (l - d) / (3 * d) * apart;
    }
  });
  for (auto& x : moved) x = x.cwiseMax(0).cwiseMin(side);
  balls.position = std::move(moved);
}

/// The foams of performance, "Foam geometry": lognormal radii, median 0.5 mm, sigma 0.5, cut to 0.15-3 mm,
/// pushed apart to the rest length. Wetness 0.8 gives about 6.7 contacts per bubble, 0.4 about 10.5.
inline Balls relaxedFoam(int count, double wetness, std::uint64_t seed) {
  constexpr double kMedian = 0.5e-3, kSigma = 0.5, kSmallest = 0.15e-3, kLargest = 3e-3;
  /// Of balls of half the rest length: random close packing, found to give those numbers of contacts.
  const double packing = wetness > 0.6 ? 0.78 : 0.74;
  constexpr int kSweeps = 100;  ///< enough for the mean compression to settle at 2 %
  Balls balls;
  double volume = 0;
  for (int i = 0; i < count; ++i) {
    CounterRandom random(seed, static_cast<std::uint64_t>(i), 1);
    const double normal =
        std::sqrt(-2 * std::log(1 - random.uniform())) * std::cos(2 * std::numbers::pi * random.uniform());
    const double r = std::min(std::max(kMedian * std::exp(kSigma * normal), kSmallest), kLargest);
    volume += ballVolume(restLength(r, r, wetness) / 2);
    balls.add({random.uniform(), random.uniform(), random.uniform()}, r);
  }
  const double side = std::cbrt(volume / packing);
  for (auto& x : balls.position) x *= side;
  OverlapPairs near;
  for (int sweep = 0; sweep < kSweeps; ++sweep) pushApart(balls, wetness, side, near);
  return balls;
}

}  // namespace spume::foam::test
