#include "fluid/surface_seed.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "fluid/cubic_interpolation.h"
#include "fluid/kinks.h"

namespace spume::fluid {
namespace {

/// Newton steps towards the closest point; the start is off by O(|grad phi| - 1), each step squares that.
constexpr int kNewtonSteps = 3;
/// Newton is done when the point moves by less than this [cells].
constexpr float kConverged = 1e-4f;
/// A closest point further off than the crossing on the nearest grid line by this factor, or with a value
/// above kMiss, is none: there the crossing itself is taken.
constexpr float kCrossingSlack = 1.1f;
constexpr float kMiss = 0.02f;
/// Radius of the patch around a closest point [cells]: twice half the diagonal of a cell, because outwards a
/// cell may hear of its nearest point's neighbour only. Beside a kink half of it.
constexpr float kPatch = 1.5f;
constexpr float kKinkPatch = 0.75f;

/// The crossing nearest to a cell along the grid lines through it.
struct Crossing {
  float distance;  ///< [cells]
  int axis;
  float direction;  ///< +-1
};
Crossing nearestCrossing(const float* p, const std::array<std::ptrdiff_t, 3>& stride) {
  Crossing nearest{std::numeric_limits<float>::max(), 0, 1};
  for (int a = 0; a < 3; ++a)
    for (const int side : {-1, 1}) {
      const float other = p[side * stride[a]];
      if ((other < 0) == (p[0] < 0)) continue;
      const float distance = p[0] / (p[0] - other);
      if (distance < nearest.distance) nearest = {distance, a, static_cast<float>(side)};
    }
  return nearest;
}

/// The interpolant near a cell, in displacements from it [cells]: cubic, or limited quadratic in cubes with a
/// kink.
struct Neighbourhood {
  const DenseField<float>& phi;
  const DenseField<std::uint8_t>& kinks;
  Eigen::Vector3i cell;

  CubicValue at(const Eigen::Vector3f& d) const {
    const Eigen::Vector3f base = d.array().floor();
    const Eigen::Vector3f t = d - base;
    const Eigen::Vector3i corner = cell + base.cast<int>();
    const float* p = &phi(corner);
    const std::ptrdiff_t si = phi.stride(0), sj = phi.stride(1);
    if (!cubeIsKinked(kinks, corner.x(), corner.y(), corner.z()))
      return cubicValue(p, si, sj, t.x(), t.y(), t.z());
    return limitedValue(p, si, sj, t.x(), t.y(), t.z());
  }
};

/// Result of the search for the closest point, as a displacement from the cell.
struct ClosestPoint {
  Eigen::Vector3f at, normal;
  float slope;  ///< |grad phi| there [phi per cell]
  bool found;
};

/// Newton on { phi(y) = 0, y parallel to grad phi(y) } from the cell's own gradient [Chopp 2001].
ClosestPoint closestPoint(const Neighbourhood& phi, float maxDistance) {
  ClosestPoint y{Eigen::Vector3f::Zero(), Eigen::Vector3f::Zero(), 0, false};
  const float limit = std::min(kCrossingSlack * maxDistance + 0.1f, 1.5f);
  float value = 0;
  for (int step = 0; step <= kNewtonSteps; ++step) {
    const CubicValue f = phi.at(y.at);
    const Eigen::Vector3f gradient(f.gx, f.gy, f.gz);
    y.slope = gradient.norm();
    if (!(y.slope > 0)) return y;
    y.normal = gradient / y.slope;
    value = f.value / y.slope;
    const Eigen::Vector3f next = (y.at.dot(y.normal) - value) * y.normal;
    const float moved = (next - y.at).norm();
    y.at = next;
    if (next.norm() > limit) return y;
    if (moved < kConverged) break;
  }
  y.found = std::abs(value) < kMiss;
  return y;
}

/// Slope along an axis from the middle of a block: across the surface if it crosses there, because beyond the
/// cells beside it distances by a wall are those to the end of the surface.
float slopeAcross(const float* p, int step) {
  const bool above = (p[step] < 0) != (p[0] < 0), below = (p[-step] < 0) != (p[0] < 0);
  if (above == below) return 0.5f * (p[step] - p[-step]);
  return above ? p[step] - p[0] : p[0] - p[-step];
}

}  // namespace

SurfaceSeed seedOf(const DenseField<float>& phi, const DenseField<std::uint8_t>& kinks,
                   const Eigen::Vector3i& cell) {
  const std::ptrdiff_t si = phi.stride(0), sj = phi.stride(1);
  const float* p = &phi(cell);
  const Eigen::Vector3f centre = cell.cast<float>();
  const Crossing crossing = nearestCrossing(p, {si, sj, 1});
  const ClosestPoint y = closestPoint({phi, kinks, cell}, crossing.distance);
  SurfaceSeed seed{};
  if (!y.found) {
    Eigen::Vector3f at = centre;
    at[crossing.axis] += crossing.direction * crossing.distance;
    seed.x = at.x(), seed.y = at.y(), seed.z = at.z();
    return seed;
  }
  const Eigen::Vector3f at = centre + y.at;
  seed.x = at.x(), seed.y = at.y(), seed.z = at.z();
  seed.nx = y.normal.x(), seed.ny = y.normal.y(), seed.nz = y.normal.z();
  seed.reach = kPatch;
  const auto second = [&](std::ptrdiff_t s) { return (p[s] - 2 * p[0] + p[-s]) / y.slope; };
  const auto mixed = [&](std::ptrdiff_t s, std::ptrdiff_t t) {
    return 0.25f * (p[s + t] - p[s - t] - p[t - s] + p[-s - t]) / y.slope;
  };
  if (kinks(cell)) {
    seed.reach = kKinkPatch;
    return seed;
  }
  seed.xx = second(si), seed.yy = second(sj), seed.zz = second(1);
  seed.xy = mixed(si, sj), seed.yz = mixed(sj, 1), seed.zx = mixed(1, si);
  return seed;
}

SurfaceSeed seedBesideWall(const DenseField<float>& phi, const WallSides& sides,
                           const Eigen::Vector3i& cell) {
  const WallSides::Block block = sides.read(phi, cell);
  const float* p = &block[WallSides::kCentre];
  const Eigen::Vector3f gradient(slopeAcross(p, 9), slopeAcross(p, 3), slopeAcross(p, 1));
  const Crossing crossing = nearestCrossing(p, {9, 3, 1});
  const Eigen::Vector3f centre = cell.cast<float>();
  const float slope = gradient.norm();
  SurfaceSeed seed{};
  Eigen::Vector3f at = centre;
  if (slope > 0 && std::abs(p[0]) <= kCrossingSlack * crossing.distance * slope) {
    const Eigen::Vector3f normal = gradient / slope;
    at -= p[0] / slope * normal;
    seed.nx = normal.x(), seed.ny = normal.y(), seed.nz = normal.z();
    seed.reach = kPatch;
  } else if (crossing.distance <= 1) {
    at[crossing.axis] += crossing.direction * crossing.distance;
  }
  seed.x = at.x(), seed.y = at.y(), seed.z = at.z();
  return seed;
}

}  // namespace spume::fluid
