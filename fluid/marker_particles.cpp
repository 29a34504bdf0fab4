#include "fluid/marker_particles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "fluid/marker_chunks.h"
#include "fluid/sampling.h"

namespace spume::fluid {
namespace {

/// Markers stay this far from walls [cells]: the smallest radius, so that no sphere is centred on a wall.
constexpr float kWallGap = 0.1f;
/// Deeper than this behind a wall a marker is removed [cells]: a wall swept over it.
constexpr float kLostDepth = 1;

/// Where a marker may be along one axis [cells]: a closed side keeps it inside, an open one lets it go.
struct Range {
  float low, high;
};
std::array<Range, 3> freeRange(const MarkerScene& scene) {
  std::array<Range, 3> range;
  const float open = 1e9f;
  for (int a = 0; a < 3; ++a) {
    range[a].low = scene.walls.closed[2 * a] ? kWallGap : -open;
    range[a].high = scene.walls.closed[2 * a + 1] ? static_cast<float>(scene.grid.cells[a]) - kWallGap : open;
  }
  return range;
}

void moveChunk(const MacView& wind, const std::array<Range, 3>& range, float cellsPerSpeed,
               MarkerSet& markers, std::size_t first, std::size_t last) {
  float *x = markers.x.data(), *y = markers.y.data(), *z = markers.z.data();
  const auto within = [](float value, Range r) { return std::min(std::max(value, r.low), r.high); };
  const Range rx = range[0], ry = range[1], rz = range[2];
  const float half = 0.5f * cellsPerSpeed;
  alignas(64) std::array<float, kMarkerChunk> mx, my, mz;
  const std::size_t count = last - first;
  x += first, y += first, z += first;
  for (std::size_t n = 0; n < count; ++n) {
    const Velocity3f u = sampleVelocity(wind, x[n], y[n], z[n]);
    mx[n] = x[n] + half * u.x;
    my[n] = y[n] + half * u.y;
    mz[n] = z[n] + half * u.z;
  }
  for (std::size_t n = 0; n < count; ++n) {
    const Velocity3f u = sampleVelocity(wind, mx[n], my[n], mz[n]);
    x[n] = within(x[n] + cellsPerSpeed * u.x, rx);
    y[n] = within(y[n] + cellsPerSpeed * u.y, ry);
    z[n] = within(z[n] + cellsPerSpeed * u.z, rz);
  }
}

constexpr float kRemoved = std::numeric_limits<float>::quiet_NaN();

/// Pushes one marker out of the solids along grad psi, or removes it.
void keepFree(const MarkerScene& scene, const FieldView& psi, MarkerSet& markers, std::size_t n) {
  const Eigen::Vector3f top = scene.grid.cells.cast<float>();
  float &x = markers.x[n], &y = markers.y[n], &z = markers.z[n];
  const auto outside = [](float value, float limit) { return !(value >= 0 && value <= limit); };
  if (outside(x, top.x()) || outside(y, top.y()) || outside(z, top.z())) {
    x = kRemoved;
    return;
  }
  // psi has values inside the grid only: sample between cell centres.
  const auto centred = [](float value, float limit) { return std::clamp(value, 0.5f, limit - 0.5f); };
  const ValueAndGradient wall =
      sampleCentredGradient(psi, centred(x, top.x()), centred(y, top.y()), centred(z, top.z()));
  const float perDx = static_cast<float>(1 / scene.grid.dx);
  const float distance = wall.value * perDx;
  if (distance >= kWallGap) return;
  if (distance < -kLostDepth) {
    x = kRemoved;
    return;
  }
  const float slope2 = (wall.gx * wall.gx + wall.gy * wall.gy + wall.gz * wall.gz) * perDx * perDx;
  const float push = (kWallGap - distance) * perDx / std::max(slope2, 0.25f);
  x = std::clamp(x + push * wall.gx, 0.0f, top.x());
  y = std::clamp(y + push * wall.gy, 0.0f, top.y());
  z = std::clamp(z + push * wall.gz, 0.0f, top.z());
}

}  // namespace

void advectMarkers(const MarkerScene& scene, const MacVelocity& velocity, double dt, MarkerSet& markers) {
  const MacView wind(velocity);
  const FieldView psi(scene.solids.psi);
  const std::array<Range, 3> range = freeRange(scene);
  const float cellsPerSpeed = static_cast<float>(dt / scene.grid.dx);
  forEachMarkerChunk(markers.size(), [&](std::size_t first, std::size_t last) {
    moveChunk(wind, range, cellsPerSpeed, markers, first, last);
    for (std::size_t n = first; n < last; ++n) keepFree(scene, psi, markers, n);
  });
}

void adjustRadii(const MarkerScene& scene, const DenseField<float>& phi, MarkerSign sign,
                 MarkerSet& markers) {
  const FieldView field(phi);
  const float toCells = static_cast<float>(static_cast<int>(sign) / scene.grid.dx);
  const float low = static_cast<float>(scene.params.markerRadiusMin);
  const float high = static_cast<float>(scene.params.markerRadiusMax);
  forEachMarkerChunk(markers.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n) {
      const float depth = toCells * sampleCentred(field, markers.x[n], markers.y[n], markers.z[n]);
      markers.radius[n] = std::min(std::max(depth, low), high);
      markers.escaped[n] = depth < -markers.radius[n];
    }
  });
}

}  // namespace spume::fluid
