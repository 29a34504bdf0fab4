#include "fluid/marker_particles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "fluid/marker_sampling.h"

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

// The loops over the markers of a chunk stand alone so that nothing they read can alias what they write, and
// vectorise into gathers.

/// One stage of a path: out = from + time u(at). The wind outside the grid is that at its nearest side.
void carry(const MacView& wind, const Eigen::Vector3f& top, float time, int count,
           const float* __restrict fromX, const float* __restrict fromY, const float* __restrict fromZ,
           const float* __restrict atX, const float* __restrict atY, const float* __restrict atZ,
           float* __restrict outX, float* __restrict outY, float* __restrict outZ) {
  const float topX = top.x(), topY = top.y(), topZ = top.z();
  for (int n = 0; n < count; ++n) {
    const Velocity3f u = sampleInnerVelocity(wind, keptInside(atX[n], topX), keptInside(atY[n], topY),
                                             keptInside(atZ[n], topZ));
    outX[n] = fromX[n] + time * u.x;
    outY[n] = fromY[n] + time * u.y;
    outZ[n] = fromZ[n] + time * u.z;
  }
}

void keepWithin(Range range, int count, const float* __restrict from, float* __restrict to) {
  for (int n = 0; n < count; ++n) {
    const float low = from[n] > range.low ? from[n] : range.low;
    to[n] = low < range.high ? low : range.high;
  }
}

void moveChunk(const MacView& wind, const Eigen::Vector3f& top, const std::array<Range, 3>& range,
               float cellsPerSpeed, MarkerSet& markers, std::size_t first, std::size_t last) {
  float *x = markers.x.data() + first, *y = markers.y.data() + first, *z = markers.z.data() + first;
  const int count = static_cast<int>(last - first);
  MarkerValues middleX, middleY, middleZ, endX, endY, endZ;
  carry(wind, top, 0.5f * cellsPerSpeed, count, x, y, z, x, y, z, middleX.data(), middleY.data(),
        middleZ.data());
  carry(wind, top, cellsPerSpeed, count, x, y, z, middleX.data(), middleY.data(), middleZ.data(), endX.data(),
        endY.data(), endZ.data());
  keepWithin(range[0], count, endX.data(), x);
  keepWithin(range[1], count, endY.data(), y);
  keepWithin(range[2], count, endZ.data(), z);
}

/// Notes which markers are outside the grid: 1, else 0.
[[gnu::noinline]] void findOutside(const Eigen::Vector3f& top, int count, const float* __restrict x,
                                   const float* __restrict y, const float* __restrict z,
                                   std::int32_t* __restrict outside) {
  const float topX = top.x(), topY = top.y(), topZ = top.z();
  for (int n = 0; n < count; ++n) {
    const bool inside =
        (x[n] >= 0) & (x[n] <= topX) & (y[n] >= 0) & (y[n] <= topY) & (z[n] >= 0) & (z[n] <= topZ);
    outside[n] = inside ? 0 : 1;
  }
}

/// Notes which markers are outside the grid or closer to a wall than `gap` [m]: 1, else 0. psi has values
/// inside the grid only: it is sampled between cell centres.
void findTouching(const FieldView& psi, const Eigen::Vector3f& top, float gap, int count,
                  const float* __restrict x, const float* __restrict y, const float* __restrict z,
                  std::int32_t* __restrict touching) {
  const float topX = top.x(), topY = top.y(), topZ = top.z();
  for (int n = 0; n < count; ++n) {
    const float ix = keptInside(x[n], topX), iy = keptInside(y[n], topY), iz = keptInside(z[n], topZ);
    const float moved = std::abs(ix - x[n]) + std::abs(iy - y[n]) + std::abs(iz - z[n]);
    const float distance = sampleInner(psi, keptInside(ix - 0.5f, topX - 1), keptInside(iy - 0.5f, topY - 1),
                                       keptInside(iz - 0.5f, topZ - 1));
    const bool clear = (moved <= 0) & (distance >= gap);
    touching[n] = clear ? 0 : 1;
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

/// Point of a moving solid's surroundings after the sub-step, if it had gone along [cell units].
Eigen::Vector3f carriedBySolid(const MarkerScene& scene, const Eigen::Vector3i& c, double dt,
                               const Eigen::Vector3f& x) {
  const int n = scene.objects ? scene.solids.object(c) : -1;
  if (n < 0 || !(*scene.objects)[n].moves) return x;
  const Eigen::Vector3d speed =
      (*scene.objects)[n].velocity(scene.grid.toWorld(x.cast<double>()), scene.middle);
  return x + (dt / scene.grid.dx * speed).cast<float>();
}

/// True if the free corner of its cell that is nearest to a marker lies beyond a wall that splits the cell.
bool isShutOff(const SolidBoundary& solids, const Eigen::Vector3i& c, const Eigen::Vector3f& x) {
  const int shut = solids.shut(c);
  if (shut == 0) return false;
  float least = std::numeric_limits<float>::max();
  bool off = false;
  for (int n = 0; n < 8; ++n) {
    const Eigen::Vector3i corner = c + Eigen::Vector3i(n & 1, n >> 1 & 1, n >> 2);
    const float square = (corner.cast<float>() - x).squaredNorm();
    if (solids.nodePsi(corner) <= 0 || square >= least) continue;
    least = square;
    off = shut >> n & 1;
  }
  return off;
}

/// Ends a marker's way at the thin wall it met; removes one that a wall has passed over.
void keepOnSide(const MarkerScene& scene, double dt, const Eigen::Vector3f& from, MarkerSet& markers,
                std::size_t n) {
  const Eigen::Vector3i last = scene.grid.cells - Eigen::Vector3i::Ones();
  const auto cellOf = [&](const Eigen::Vector3f& x) -> Eigen::Vector3i {
    return x.array().floor().cast<int>().max(0).min(last.array());
  };
  Eigen::Vector3i cell = cellOf(from);
  if (!(scene.solids.sides.guard(cell) & WallSides::kInReach) || std::isnan(markers.x[n])) return;
  const Eigen::Vector3f start = carriedBySolid(scene, cell, dt, from);
  cell = cellOf(start);
  const Walk walk = walkThroughFaces(scene.solids, cell, start, {markers.x[n], markers.y[n], markers.z[n]});
  markers.x[n] = walk.at.x(), markers.y[n] = walk.at.y(), markers.z[n] = walk.at.z();
  const bool closed = !scene.solids.hasOpenFace(walk.cell.x(), walk.cell.y(), walk.cell.z());
  if (closed || isShutOff(scene.solids, walk.cell, walk.at)) markers.x[n] = kRemoved;
}

}  // namespace

void advectMarkers(const MarkerScene& scene, const MacVelocity& velocity, double dt, MarkerSet& markers) {
  const MacView wind(velocity);
  const FieldView psi(scene.solids.psi);
  const std::array<Range, 3> range = freeRange(scene);
  const Eigen::Vector3f top = scene.grid.cells.cast<float>();
  const float cellsPerSpeed = static_cast<float>(dt / scene.grid.dx);
  const float gap = kWallGap * static_cast<float>(scene.grid.dx);
  const bool thinWalls = scene.solids.sides.any();
  const bool wallsAlone = scene.objects && scene.objects->empty();  // the range keeps them off these
  forEachMarkerChunk(markers.size(), [&](std::size_t first, std::size_t last) {
    MarkerValues fromX, fromY, fromZ;
    if (thinWalls) {
      std::copy(markers.x.begin() + first, markers.x.begin() + last, fromX.begin());
      std::copy(markers.y.begin() + first, markers.y.begin() + last, fromY.begin());
      std::copy(markers.z.begin() + first, markers.z.begin() + last, fromZ.begin());
    }
    moveChunk(wind, top, range, cellsPerSpeed, markers, first, last);
    MarkerCells touching;
    const int count = static_cast<int>(last - first);
    const float *x = markers.x.data() + first, *y = markers.y.data() + first, *z = markers.z.data() + first;
    if (wallsAlone)
      findOutside(top, count, x, y, z, touching.data());
    else
      findTouching(psi, top, gap, count, x, y, z, touching.data());
    for (std::size_t n = first; n < last; ++n)
      if (touching[n - first]) keepFree(scene, psi, markers, n);
    for (std::size_t n = first; thinWalls && n < last; ++n)
      keepOnSide(scene, dt, {fromX[n - first], fromY[n - first], fromZ[n - first]}, markers, n);
  });
}

namespace {

void boundRadii(float toSide, float low, float high, int count, const float* __restrict value,
                float* __restrict radius) {
  for (int n = 0; n < count; ++n) {
    const float depth = toSide * value[n];
    const float least = depth > low ? depth : low;
    radius[n] = least < high ? least : high;
  }
}

}  // namespace

void adjustRadii(const MarkerScene& scene, const DenseField<float>& phi, MarkerSign sign,
                 MarkerSet& markers) {
  const float toCells = static_cast<float>(static_cast<int>(sign) / scene.grid.dx);
  const float low = static_cast<float>(scene.params.markerRadiusMin);
  const float high = static_cast<float>(scene.params.markerRadiusMax);
  forEachMarkerChunk(markers.size(), [&](std::size_t first, std::size_t last) {
    MarkerValues values;
    sampleAtMarkers(phi, scene.solids.sides, markers, first, last, values);
    boundRadii(toCells, low, high, static_cast<int>(last - first), values.data(),
               markers.radius.data() + first);
    flagEscapedMarkers(values, toCells, first, last, markers);
  });
}

}  // namespace spume::fluid
