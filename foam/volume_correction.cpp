#include "foam/volume_correction.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "foam/parallel.h"
#include "foam/volume_newton.h"

namespace spume::foam {
namespace {

/// Largest change of a radius in one projection: the derivatives hold no further.
constexpr double kLargestChange = 0.1;
constexpr double kNewtonTolerance = 1e-6;  ///< relative residual, far below the error of linearising

double ballVolume(double radius) { return 4 * std::numbers::pi / 3 * radius * radius * radius; }

bool hasCell(const FoamTopology& topology, std::size_t i) {
  return !topology.hidden[i] && topology.volume[i] > 0;
}

/// Sets a radius within its limit.
void setRadius(const FoamParams& params, std::size_t i, double wanted, BubbleStore& bubbles) {
  const double most = params.radiusLimit * gasRadius(bubbles.gas[i]);
  bubbles.clamped[i] = wanted > most;
  bubbles.radius[i] = std::min(wanted, most);
}

}  // namespace

double gasRadius(double gas) { return std::cbrt(3 * gas / (4 * std::numbers::pi)); }

bool holdsVolumes(const FoamParams& params) {
  return params.volumeMode == VolumeMode::newton && params.volumeRate > 0;
}

void noteVolumes(const FoamTopology& topology, BubbleStore& bubbles) {
  bubbles.volume = topology.volume;
  bubbles.hidden = topology.hidden;
}

double worstVolumeError(const BubbleStore& bubbles) {
  const auto errorOf = [&](std::size_t i) {
    return bubbles.hidden[i] || bubbles.clamped[i] ? 0 : std::abs(bubbles.volume[i] / bubbles.gas[i] - 1);
  };
  return reduceIndices(bubbles.size(), 0.0, errorOf, [](double a, double b) { return std::max(a, b); });
}

void correctVolumes(const FoamParams& params, const FoamTopology& topology, double dt, BubbleStore& bubbles) {
  noteVolumes(topology, bubbles);
  const double strength = -std::expm1(-params.volumeRate * dt);
  const bool hiddenOnly = holdsVolumes(params);
  forEachIndex(bubbles.size(), [&](std::size_t i) {
    const bool cell = hasCell(topology, i);
    if (cell && hiddenOnly) return;
    const double r = bubbles.radius[i], volume = cell ? bubbles.volume[i] : ballVolume(r);
    setRadius(params, i, r * std::pow(bubbles.gas[i] / volume, strength / 3), bubbles);
  });
}

void projectVolumes(const FoamParams& params, const FoamTopology& topology, BubbleStore& bubbles) {
  std::vector<double> missing(bubbles.size(), 0.0), change;
  std::vector<char> atLimit(bubbles.size(), 0);
  for (std::size_t i = 0; i < missing.size(); ++i) {
    if (!hasCell(topology, i)) continue;
    missing[i] = bubbles.gas[i] - topology.volume[i];
    atLimit[i] = bubbles.clamped[i] && missing[i] > 0;
  }
  solveWeightChanges(topology, bubbles.radius, missing, atLimit, kNewtonTolerance, change);
  for (std::size_t i = 0; i < missing.size(); ++i) {
    if (!hasCell(topology, i) || atLimit[i]) continue;
    const double r = bubbles.radius[i], most = 1 + kLargestChange;
    setRadius(params, i, std::clamp(std::sqrt(std::max(r * r + change[i], 0.0)), r / most, r * most),
              bubbles);
  }
}

}  // namespace spume::foam
