#include "foam/classification.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "foam/lane_math.h"
#include "foam/parallel.h"

namespace spume::foam {
namespace {

// On the unit sphere: >= 200 asked for, and 512 resolve kFullWetShare in 51 steps.
constexpr std::size_t kSamples = 512;
/// Samples in a patch: neighbours on the sphere, so that one test can tell that none of them is wet.
constexpr std::size_t kPatch = 8, kPatches = kSamples / kPatch;
static_assert(kPatch % kLanes == 0 && kPatches == 64, "whole lanes, and a bit of a word for each patch");
// A sample counts partly while a boundary runs within half its own width of it: w then varies continuously.
const double kRamp = std::sqrt(4 * std::numbers::pi / kSamples);

using Direction = std::array<double, 3>;

/// Points spread evenly over the unit sphere along a golden-angle spiral.
std::vector<Direction> spiralDirections() {
  std::vector<Direction> directions(kSamples);
  const double goldenAngle = std::numbers::pi * (3 - std::sqrt(5.0));
  for (std::size_t s = 0; s < kSamples; ++s) {
    const auto at = static_cast<double>(s);
    const double y = 1 - (2 * at + 1) / kSamples, across = std::sqrt(1 - y * y);
    directions[s] = {across * std::cos(goldenAngle * at), y, across * std::sin(goldenAngle * at)};
  }
  return directions;
}

/// Orders directions first .. last - 1 so that every kPatch of them, counted from the first, are near each
/// other: halves along the widest axis, again and again.
void sortToPatches(std::vector<Direction>::iterator first, std::vector<Direction>::iterator last) {
  if (last - first <= static_cast<std::ptrdiff_t>(kPatch)) return;
  std::size_t widest = 0;
  double width = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto less = [axis](const Direction& a, const Direction& b) { return a[axis] < b[axis]; };
    const auto [low, high] = std::minmax_element(first, last, less);
    if ((*high)[axis] - (*low)[axis] > width) width = (*high)[axis] - (*low)[axis], widest = axis;
  }
  const auto middle = first + (last - first) / 2;
  std::nth_element(first, middle, last,
                   [widest](const Direction& a, const Direction& b) { return a[widest] < b[widest]; });
  sortToPatches(first, middle), sortToPatches(middle, last);
}

/// Points as columns.
template <std::size_t N>
struct Columns {
  std::array<double, N> x, y, z;

  Lanes dot(const Eigen::Vector3d& axis, std::size_t k) const {
    return loadLanes(&x[k]) * axis.x() + loadLanes(&y[k]) * axis.y() + loadLanes(&z[k]) * axis.z();
  }
};

/// The samples, patch after patch.
struct SampleSphere {
  Columns<kSamples> sample;
  Columns<kPatches> centre;  ///< of the patches
  double extent = 0;         ///< no sample is farther from the centre of its patch [-]

  SampleSphere() {
    std::vector<Direction> directions = spiralDirections();
    sortToPatches(directions.begin(), directions.end());
    for (std::size_t s = 0; s < kSamples; ++s)
      sample.x[s] = directions[s][0], sample.y[s] = directions[s][1], sample.z[s] = directions[s][2];
    for (std::size_t p = 0; p < kPatches; ++p) {
      Eigen::Matrix<double, 3, kPatch> points;
      for (std::size_t s = 0; s < kPatch; ++s)
        points.col(static_cast<Eigen::Index>(s)) = Eigen::Vector3d::Map(directions[p * kPatch + s].data());
      const Eigen::Vector3d middle = points.rowwise().mean();
      centre.x[p] = middle.x(), centre.y[p] = middle.y(), centre.z[p] = middle.z();
      extent = std::max(extent, (points.colwise() - middle).colwise().norm().maxCoeff());
    }
  }
};

Lanes ramp(const Lanes& distance) {
  const Lanes share = 0.5 + distance / kRamp, none = {}, all = none + 1;
  const Lanes above = share > none ? share : none;
  return above < all ? above : all;
}

/// A part of a bubble's sphere that is not wet, inside a neighbour or above the surface: directions q with
/// q . axis > cosine.
struct Cap {
  Eigen::Vector3d axis;
  double cosine;
};

Cap capInside(const BubbleStore& bubbles, std::size_t i, std::int32_t j, double distance) {
  const double ri = bubbles.radius[i], rj = bubbles.radius[j];
  if (distance <= std::abs(ri - rj)) return {Eigen::Vector3d::UnitY(), ri <= rj ? -1.0 - kRamp : 1.0 + kRamp};
  const Eigen::Vector3d axis = (bubbles.position[j] - bubbles.position[i]) / distance;
  return {axis, (distance * distance + ri * ri - rj * rj) / (2 * distance * ri)};
}

/// The patches that are not wholly inside one of the caps, a bit each.
std::uint64_t patchesOutside(const SampleSphere& sphere, const std::vector<Cap>& caps) {
  std::uint64_t outside = ~std::uint64_t{0};
  for (const Cap& cap : caps) {
    const double innermost = cap.cosine + sphere.extent + 0.5 * kRamp;
    std::uint64_t left = 0;
    for (std::size_t k = 0; k < kPatches; k += kLanes)
      left |= std::uint64_t{bitsOf(sphere.centre.dot(cap.axis, k) < innermost)} << k;
    outside &= left;
  }
  return outside;
}

/// Share of a sphere outside all caps by samples; stops once it is known to reach the full share.
double sampledWetShare(const std::vector<Cap>& caps) {
  static const SampleSphere sphere;
  double count = 0;
  for (std::uint64_t left = patchesOutside(sphere, caps); left != 0; left &= left - 1) {
    const std::size_t begin = kPatch * static_cast<std::size_t>(std::countr_zero(left));
    for (std::size_t k = begin; k < begin + kPatch; k += kLanes) {
      Lanes share = Lanes{} + 1;
      for (std::size_t c = 0; c < caps.size() && bitsOf(share > 0) != 0; ++c)
        share *= ramp(caps[c].cosine - sphere.sample.dot(caps[c].axis, k));
      count += sumOf(share);
    }
    if (count >= kFullWetShare * kSamples) return kFullWetShare;
  }
  return count / kSamples;
}

double weightAfloat(const BubbleStore& bubbles, std::size_t i, double phi, const Eigen::Vector3d& gradPhi,
                    const FoamTopology& topology, const Neighbours& neighbours) {
  const double level = phi / bubbles.radius[i];
  const double wetShare = 0.5 * (1 - level);
  double coveredShare = 0;
  thread_local std::vector<Cap> caps;
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
  caps.push_back({gradPhi / slope, -level});
  std::swap(caps.front(), caps.back());  // most of what is not wet is above the surface
  return sampledWetShare(caps) / kFullWetShare;
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
  forEachIndex(bubbles.size(), [&](std::size_t i) {
    bubbles.type[i] = reclassify(bubbles.type[i], phi[i], bubbles.radius[i], bubbles.surfaceWeight[i]);
  });
}

}  // namespace spume::foam
