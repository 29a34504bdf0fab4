#include "foam/volume_correction.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "foam/parallel.h"
#include "foam/volume_newton.h"

namespace spume::foam {
namespace {

/// Largest growth of a radius in one projection: the derivatives hold no further. From above they lead
/// towards the answer from any distance.
constexpr double kLargestGrowth = 0.25;
constexpr double kNewtonTolerance = 1e-3;  ///< relative residual, below the error of linearising

bool hasCell(const FoamTopology& topology, std::size_t i) {
  return !topology.hidden[i] && topology.volume[i] > 0;
}

/// Sets a radius within its limit. Few are beyond it, and volumes tell who is without a root.
void setRadius(const FoamParams& params, std::size_t i, double wanted, BubbleStore& bubbles) {
  const double gas = bubbles.gas[i];
  const bool isBeyond = ballVolume(wanted / params.radiusLimit) > gas;
  bubbles.clamped[i] = isBeyond;
  bubbles.radius[i] = isBeyond ? params.radiusLimit * gasRadius(gas) : wanted;
}

}  // namespace

double ballVolume(double radius) { return 4 * std::numbers::pi / 3 * radius * radius * radius; }

double gasRadius(double gas) { return std::cbrt(3 * gas / (4 * std::numbers::pi)); }

bool holdsVolumes(const FoamParams& params) {
  return params.volumeMode == VolumeMode::newton && params.volumeRate > 0;
}

void noteVolumes(const FoamTopology& topology, BubbleStore& bubbles) {
  bubbles.volume = topology.volume;
  bubbles.hidden = topology.hidden;
}

std::vector<std::int32_t> cellsOff(const BubbleStore& bubbles, double tolerance) {
  std::vector<std::int32_t> rows;
  for (std::size_t i = 0; i < bubbles.size(); ++i) {
    const bool counts = !bubbles.hidden[i] && !bubbles.clamped[i];
    if (counts && std::abs(bubbles.volume[i] / bubbles.gas[i] - 1) > tolerance)
      rows.push_back(static_cast<std::int32_t>(i));
  }
  return rows;
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

void projectVolumes(const FoamParams& params, const FoamTopology& topology, const Neighbours& neighbours,
                    const std::vector<char>& fixed, BubbleStore& bubbles) {
  std::vector<double> missing(bubbles.size(), 0.0), change;
  std::vector<char> stays = fixed;
  stays.resize(bubbles.size(), 0);
  forEachIndex(missing.size(), [&](std::size_t i) {
    if (!hasCell(topology, i) || stays[i]) return;
    missing[i] = bubbles.gas[i] - topology.volume[i];
    stays[i] = bubbles.clamped[i] && missing[i] > 0;
  });
  solveWeightChanges(topology, neighbours, bubbles.radius, missing, stays, kNewtonTolerance, change);
  forEachIndex(missing.size(), [&](std::size_t i) {
    if (!hasCell(topology, i) || stays[i]) return;
    const double r = bubbles.radius[i], wanted = std::sqrt(std::max(r * r + change[i], 0.0));
    const double least = gasRadius(bubbles.gas[i]);  // no smaller ball holds the gas
    setRadius(params, i, std::max(least, std::min(wanted, r * (1 + kLargestGrowth))), bubbles);
  });
}

}  // namespace spume::foam
