#include "foam/volume_correction.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "foam/parallel.h"
#include "foam/volume_newton.h"

namespace spume::foam {
namespace {

/// A foam whose bubbles all move less than this share of their radius in a step is at rest: a correction at
/// full strength then has no stiff motion to feed (model: it destabilises piles that move).
constexpr double kRestShare = 1e-3;
/// Largest change of a radius in one step of `newton`: the derivatives hold no further.
constexpr double kLargestChange = 0.1;
constexpr double kNewtonTolerance = 1e-6;  ///< relative residual, far below the error of linearising

double ballVolume(double radius) { return 4 * std::numbers::pi / 3 * radius * radius * radius; }

bool isAtRest(const BubbleStore& bubbles, double dt) {
  for (std::size_t i = 0; i < bubbles.size(); ++i)
    if (bubbles.velocity[i].norm() * dt > kRestShare * bubbles.radius[i]) return false;
  return true;
}

/// Radii that move each cell by itself: r (V0 / V)^(strength / 3).
void relaxedRadii(const BubbleStore& bubbles, const std::vector<std::uint8_t>& hasCell, double strength,
                  std::vector<double>& wanted) {
  forEachIndex(bubbles.size(), [&](std::size_t i) {
    const double volume = hasCell[i] ? bubbles.volume[i] : ballVolume(bubbles.radius[i]);
    wanted[i] = bubbles.radius[i] * std::pow(bubbles.gas[i] / volume, strength / 3);
  });
}

/// Radii of a Newton step for all cells together.
void newtonRadii(const FoamTopology& topology, const BubbleStore& bubbles,
                 const std::vector<std::uint8_t>& hasCell, double strength, std::vector<double>& wanted) {
  std::vector<double> missing(bubbles.size(), 0.0), change;
  for (std::size_t i = 0; i < missing.size(); ++i)
    if (hasCell[i]) missing[i] = strength * (bubbles.gas[i] - bubbles.volume[i]);
  solveWeightChanges(topology, bubbles.radius, missing, kNewtonTolerance, change);
  for (std::size_t i = 0; i < missing.size(); ++i) {
    if (!hasCell[i]) continue;
    const double r = bubbles.radius[i], most = 1 + kLargestChange;
    wanted[i] = std::clamp(std::sqrt(std::max(r * r + change[i], 0.0)), r / most, r * most);
  }
}

}  // namespace

double gasRadius(double gas) { return std::cbrt(3 * gas / (4 * std::numbers::pi)); }

void correctVolumes(const FoamParams& params, const FoamTopology& topology, double dt, BubbleStore& bubbles) {
  const std::size_t n = bubbles.size();
  std::vector<std::uint8_t> hasCell(n);
  forEachIndex(n, [&](std::size_t i) {
    hasCell[i] = !topology.hidden[i] && topology.volume[i] > 0;
    bubbles.volume[i] = topology.volume[i];
    bubbles.hidden[i] = topology.hidden[i];
  });
  const double strength = -std::expm1(-params.volumeRate * dt);
  std::vector<double> wanted(n);
  relaxedRadii(bubbles, hasCell, strength, wanted);
  if (params.volumeMode == VolumeMode::newton && params.volumeRate > 0)
    newtonRadii(topology, bubbles, hasCell, isAtRest(bubbles, dt) ? 1 : strength, wanted);
  forEachIndex(n, [&](std::size_t i) {
    const double most = params.radiusLimit * gasRadius(bubbles.gas[i]);
    bubbles.clamped[i] = wanted[i] > most;
    bubbles.radius[i] = std::min(wanted[i], most);
  });
}

}  // namespace spume::foam
