#include "foam/classification.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "foam/parallel.h"

namespace spume::foam {
namespace {

constexpr int kSamples =
    512;  // on the unit sphere; >= 200 asked for, and 512 resolve kFullWetShare in 51 steps
// A sample counts partly while a boundary runs within half its own width of it: w then varies continuously.
const double kRamp = std::sqrt(4 * std::numbers::pi / kSamples);

using Directions = std::array<Eigen::Vector3d, kSamples>;

/// Points spread evenly over the unit sphere along a golden-angle spiral.
Directions spiralDirections() {
  Directions directions;
  const double goldenAngle = std::numbers::pi * (3 - std::sqrt(5.0));
  for (int s = 0; s < kSamples; ++s) {
    const double y = 1 - (2 * s + 1.0) / kSamples, across = std::sqrt(1 - y * y);
    directions[s] = {across * std::cos(goldenAngle * s), y, across * std::sin(goldenAngle * s)};
  }
  return directions;
}

double ramp(double distance) { return std::clamp(0.5 + distance / kRamp, 0.0, 1.0); }

/// The part of a bubble's sphere inside a neighbour: directions q with q . axis > cosine.
struct CoveredCap {
  Eigen::Vector3d axis;
  double cosine;
};

CoveredCap capInside(const BubbleStore& bubbles, std::size_t i, std::int32_t j, double distance) {
  const double ri = bubbles.radius[i], rj = bubbles.radius[j];
  if (distance <= std::abs(ri - rj)) return {Eigen::Vector3d::UnitY(), ri <= rj ? -1.0 - kRamp : 1.0 + kRamp};
  const Eigen::Vector3d axis = (bubbles.position[j] - bubbles.position[i]) / distance;
  return {axis, (distance * distance + ri * ri - rj * rj) / (2 * distance * ri)};
}

/// Wet, uncovered share of a sphere by samples; stops once it is known to reach the full share.
double sampledWetShare(const std::vector<CoveredCap>& caps, const Eigen::Vector3d& up, double level) {
  static const Directions directions = spiralDirections();
  double count = 0;
  for (const Eigen::Vector3d& q : directions) {
    double share = ramp(-level - q.dot(up));
    for (std::size_t c = 0; c < caps.size() && share > 0; ++c)
      share *= ramp(caps[c].cosine - q.dot(caps[c].axis));
    count += share;
    if (count >= kFullWetShare * kSamples) return kFullWetShare;
  }
  return count / kSamples;
}

double weightAfloat(const BubbleStore& bubbles, std::size_t i, double phi, const Eigen::Vector3d& gradPhi,
                    const FoamTopology& topology, const Neighbours& neighbours) {
  const double level = phi / bubbles.radius[i];
  const double wetShare = 0.5 * (1 - level);
  double coveredShare = 0;
  thread_local std::vector<CoveredCap> caps;
  caps.clear();
  for (std::int32_t e = neighbours.start[i]; e < neighbours.start[i + 1]; ++e) {
    caps.push_back(
        capInside(bubbles, i, neighbours.other[e], topology.overlaps[neighbours.pair[e]].distance));
    coveredShare += 0.5 * (1 - std::clamp(caps.back().cosine, -1.0, 1.0));
  }
  if (caps.empty() || wetShare - coveredShare >= kFullWetShare)
    return std::min(1.0, wetShare / kFullWetShare);
  const double slope = gradPhi.norm();
  if (slope == 0) return phi <= 0 ? 1 : 0;
  return sampledWetShare(caps, gradPhi / slope, level) / kFullWetShare;
}

}  // namespace

BubbleClass classify(double phi, double radius, double surfaceWeight) {
  if (phi < -radius) return BubbleClass::liquid;
  return phi <= radius && surfaceWeight > 0 ? BubbleClass::surface : BubbleClass::air;
}

void weighSurface(const Surroundings& around, const FoamTopology& topology, const Neighbours& neighbours,
                  BubbleStore& bubbles) {
  forEachIndex(bubbles.size(), [&](std::size_t i) {
    const double phi = around.phi[i], radius = bubbles.radius[i];
    if (std::abs(phi) > radius)
      bubbles.surfaceWeight[i] = phi < 0 ? 1 : 0;
    else
      bubbles.surfaceWeight[i] = weightAfloat(bubbles, i, phi, around.gradPhi.col(i), topology, neighbours);
  });
}

BubbleClass reclassify(BubbleClass before, double phi, double radius, double surfaceWeight) {
  const BubbleClass now = classify(phi, radius, surfaceWeight);
  const bool stillDeep = phi < -(1 - kClassMargin) * radius;
  if (before == BubbleClass::liquid && now != before && stillDeep) return before;
  const bool stillNear = phi > radius && phi <= (1 + kClassMargin) * radius;
  if (before == BubbleClass::surface && stillNear) return before;
  if (before == BubbleClass::air && now == BubbleClass::surface && surfaceWeight < 1) return before;
  return now;
}

void relabel(const Eigen::VectorXd& phi, BubbleStore& bubbles) {
  for (std::size_t i = 0; i < bubbles.size(); ++i)
    bubbles.type[i] = reclassify(bubbles.type[i], phi[i], bubbles.radius[i], bubbles.surfaceWeight[i]);
}

}  // namespace spume::foam
