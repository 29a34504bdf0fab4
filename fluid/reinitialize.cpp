#include "fluid/reinitialize.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fluid/kinks.h"
#include "fluid/level_set.h"
#include "fluid/parallel.h"
#include "fluid/sampling.h"

namespace spume::fluid {
namespace {

/// Layers of face-neighbour steps: along a space diagonal a step gains 1/sqrt(3) cells.
constexpr int kLayers = 10;
static_assert(kLayers * kLayers >= kLevelSetBand * kLevelSetBand * 2, "the band is not covered");
/// Extra rounds over all layers at the end, in which cells hear from all their neighbours once more.
constexpr int kFinalPasses = 1;
/// A cell beside the surface whose value is a distance to within this keeps it [cells]: made a distance again
/// and again the interpolant's error would creep, for a sphere of radius 3 by 0.07 % of its volume each time.
constexpr float kSameDistance = 3e-3f;
/// Any cell keeps a value that differs by no more than the round-off of a seed's place in a grid of 1024
/// [cells]: a level surface then stays level to the bit beside walls, too.
constexpr float kSamePlace = 6e-5f;
/// Cells of a layer handled by one task at least.
constexpr std::size_t kCellGrain = 256;

/// Distance from a point to the patch around a seed [cells]. Without branches: a loop over it vectorises.
float patchDistance(const SurfaceSeed& s, float x, float y, float z) {
  const float rx = x - s.x, ry = y - s.y, rz = z - s.z;
  const float h = rx * s.nx + ry * s.ny + rz * s.nz;
  const float tx = rx - h * s.nx, ty = ry - h * s.ny, tz = rz - h * s.nz;
  const float square = tx * tx + ty * ty + tz * tz, tangential = std::sqrt(square);
  const float onPatch = smaller(tangential, s.reach);
  const float bend = (s.xx * tx * tx + s.yy * ty * ty + s.zz * tz * tz +
                      2 * (s.xy * tx * ty + s.yz * ty * tz + s.zx * tz * tx)) /
                     square;
  // The surface falls away by bend t^2/2 at t; parallel surfaces at distance h have curvature bend/(1 + h
  // bend).
  const float height = h + 0.5f * bend * onPatch * onPatch / larger(1 + h * bend, 0.3f);
  const float beyond = tangential - onPatch;
  const float toEdge = std::sqrt(height * height + beyond * beyond);
  const float toPatch = beyond > 0 ? toEdge : std::abs(height);
  const float toPoint = std::sqrt(rx * rx + ry * ry + rz * rz);
  return onPatch > 0 ? toPatch : toPoint;
}

/// Distance of each cell of a row to the patch around its seed, `band` where it has none. On its own so that
/// nothing it reads can alias what it writes.
[[gnu::noinline]] void patchDistances(const SurfaceSeed* __restrict seeds,
                                      const std::int32_t* __restrict seedOf, float x, float y, float z,
                                      float band, int count, float* __restrict distance) {
  for (int n = 0; n < count; ++n) {
    const std::int32_t known = seedOf[n] < 0 ? 0 : seedOf[n];
    const float toPatch = patchDistance(seeds[known], x, y, z + static_cast<float>(n));
    distance[n] = seedOf[n] < 0 ? band : smaller(toPatch, band);
  }
}

/// Cells looked at together: a loop over them vectorises into gathers.
constexpr int kBatch = 64;

/// Places of a batch of cells, in index units.
struct alignas(64) CellBatch {
  float x[kBatch], y[kBatch], z[kBatch];
};

/// Places of the seeds, in index units.
struct SeedView {
  const float *x, *y, *z;
};

/// The nearer of two seeds to a cell; -1 is none, ties go to the lower number.
struct NearestSeed {
  std::int32_t seed = -1;
  float square = std::numeric_limits<float>::max();

  void offer(const SeedView& seeds, std::int32_t other, float x, float y, float z) {
    const std::int32_t known = other < 0 ? 0 : other;
    const float dx = x - seeds.x[known], dy = y - seeds.y[known], dz = z - seeds.z[known];
    const float distance = dx * dx + dy * dy + dz * dz;
    const bool nearer = (distance < square) | ((distance == square) & (other < seed));
    const bool taken = nearer & (other >= 0);
    seed = taken ? other : seed;
    square = taken ? distance : square;
  }
};

/// For each cell of a batch the nearest of the seeds that its neighbours know and, unless `outwardsOnly`,
/// itself. On its own so that nothing it reads can alias what it writes.
[[gnu::noinline]] void nearestSeeds(const std::int32_t* __restrict seedOf, int si, int sj, bool outwardsOnly,
                                    SeedView seeds, const std::int32_t* __restrict cell, int count,
                                    const float* __restrict atX, const float* __restrict atY,
                                    const float* __restrict atZ, std::int32_t* __restrict nearest) {
  const std::int32_t hidden = outwardsOnly ? -1 : 0;  // all bits set: none
  for (int n = 0; n < count; ++n) {
    const std::int32_t c = cell[n];
    const float x = atX[n], y = atY[n], z = atZ[n];
    NearestSeed best;
    best.offer(seeds, seedOf[c] | hidden, x, y, z);
    best.offer(seeds, seedOf[c - si], x, y, z);
    best.offer(seeds, seedOf[c + si], x, y, z);
    best.offer(seeds, seedOf[c - sj], x, y, z);
    best.offer(seeds, seedOf[c + sj], x, y, z);
    best.offer(seeds, seedOf[c - 1], x, y, z);
    best.offer(seeds, seedOf[c + 1], x, y, z);
    nearest[n] = best.seed;
  }
}

/// Marks one row of cells that differ in sign from a neighbour. On its own so that nothing the loop reads can
/// alias the bytes it writes.
void markCrossedRow(const float* __restrict p, std::uint8_t* __restrict mark, std::ptrdiff_t si,
                    std::ptrdiff_t sj, int count) {
  for (int k = 0; k < count; ++k) {
    const float low = std::min(std::min(std::min(p[k - si], p[k + si]), std::min(p[k - sj], p[k + sj])),
                               std::min(p[k - 1], p[k + 1]));
    const float high = std::max(std::max(std::max(p[k - si], p[k + si]), std::max(p[k - sj], p[k + sj])),
                                std::max(p[k - 1], p[k + 1]));
    const bool crossed = p[k] < 0 ? high >= 0 : low < 0;
    mark[k] = crossed ? std::uint8_t{0} : LayerList::kUnreached;
  }
}

void barRow(const float* __restrict psi, std::uint8_t* __restrict mark, int count) {
  for (int k = 0; k < count; ++k) mark[k] = psi[k] <= 0 ? LayerList::kBarred : mark[k];
}

}  // namespace

Reinitializer::Reinitializer(const GridSpec& grid)
    : grid_(grid), layers_(grid.cells), kinks_(grid.cells), seedOf_(grid.cells, -1) {}

void Reinitializer::markInterface(const DenseField<float>& phi, const SolidBoundary* solids) {
  DenseField<std::uint8_t>& marks = layers_.marks();
  const int nz = grid_.cells.z();
  forEachRow(grid_.cells, [&](int i, int j) {
    markCrossedRow(&phi(i, j, 0), &marks(i, j, 0), phi.stride(0), phi.stride(1), nz);
    if (solids) barRow(&solids->psi(i, j, 0), &marks(i, j, 0), nz);
  });
}

/// Beside walls the surface crosses between cells of the same side alone.
void Reinitializer::markBesideWalls(const DenseField<float>& phi) {
  const WallSides& sides = solids_->sides;
  for (const Eigen::Vector3i& c : sides.cellsByWalls()) {
    std::uint8_t& mark = layers_.marks()(c);
    if (mark == LayerList::kBarred) continue;
    bool crossed = false;
    for (int a = 0; a < 3; ++a)
      for (const int side : {-1, 1}) {
        const Eigen::Vector3i n = c + side * Eigen::Vector3i::Unit(a);
        if (phi.contains(n.x(), n.y(), n.z()) && sides.sees(c, n)) crossed |= (phi(n) < 0) != (phi(c) < 0);
      }
    mark = crossed ? std::uint8_t{0} : LayerList::kUnreached;
  }
}

void Reinitializer::plantSeeds(const DenseField<float>& phi) {
  const auto cells = layers_.layer(0);
  seeds_.resize(cells.size());
  for (std::vector<float>* column : {&seedX_, &seedY_, &seedZ_}) column->resize(cells.size());
  forEachRow(grid_.cells, [&](int i, int j) { std::fill_n(&seedOf_(i, j, 0), grid_.cells.z(), -1); });
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, cells.size()), [&](const auto& range) {
    RowCursor at(seedOf_);
    for (std::size_t n = range.begin(); n < range.end(); ++n) {
      at.seek(cells[n]);
      const Eigen::Vector3i cell(at.i, at.j, at.k);
      const bool byWall = solids_ && solids_->sides.guard(cell) & WallSides::kByWall;
      seeds_[n] = byWall ? seedBesideWall(phi, solids_->sides, cell) : seedOf(phi, kinks_, cell);
      seedX_[n] = seeds_[n].x, seedY_[n] = seeds_[n].y, seedZ_[n] = seeds_[n].z;
      seedOf_.data()[cells[n]] = static_cast<std::int32_t>(n);
    }
  });
}

void Reinitializer::spreadLayer(int layer, bool outwardsOnly) {
  const auto cells = layers_.layer(layer);
  update_.resize(std::max(update_.size(), cells.size()));
  const auto forEachPart = [&](const auto& body) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, cells.size(), kCellGrain), body);
  };
  const std::ptrdiff_t si = seedOf_.stride(0), sj = seedOf_.stride(1);
  const SeedView seeds{seedX_.data(), seedY_.data(), seedZ_.data()};
  forEachPart([&](const auto& range) {
    RowCursor at(seedOf_);
    CellBatch batch;
    for (std::size_t first = range.begin(); first < range.end(); first += kBatch) {
      const int count = static_cast<int>(std::min<std::size_t>(kBatch, range.end() - first));
      for (int n = 0; n < count; ++n) {
        at.seek(cells[first + n]);
        batch.x[n] = static_cast<float>(at.i);
        batch.y[n] = static_cast<float>(at.j);
        batch.z[n] = static_cast<float>(at.k);
      }
      nearestSeeds(seedOf_.data(), static_cast<int>(si), static_cast<int>(sj), outwardsOnly, seeds,
                   cells.data() + first, count, batch.x, batch.y, batch.z, update_.data() + first);
    }
  });
  forEachPart([&](const auto& range) {
    for (std::size_t n = range.begin(); n < range.end(); ++n) seedOf_.data()[cells[n]] = update_[n];
  });
}

void Reinitializer::measure(DenseField<float>& phi) const {
  const float dx = static_cast<float>(grid_.dx), same = kSameDistance * dx;
  const SurfaceSeed none{};
  const SurfaceSeed* seeds = seeds_.empty() ? &none : seeds_.data();
  forEachRow(grid_.cells, [&](int i, int j) {
    const std::uint8_t* mark = &layers_.marks()(i, j, 0);
    float* p = &phi(i, j, 0);
    alignas(64) float distance[kBatch];
    for (int first = 0; first < grid_.cells.z(); first += kBatch) {
      const int end = std::min(first + kBatch, grid_.cells.z());
      patchDistances(seeds, &seedOf_(i, j, first), static_cast<float>(i), static_cast<float>(j),
                     static_cast<float>(first), kLevelSetBand, end - first, distance);
      for (int k = first; k < end; ++k) {
        const float size = dx * distance[k - first];
        const bool barred = mark[k] == LayerList::kBarred;
        const bool keeps = std::abs(std::abs(p[k]) - size) < (mark[k] == 0 ? same : kSamePlace * dx);
        const float moved = p[k] < 0 ? -size : size;
        p[k] = barred || keeps ? p[k] : moved;
      }
    }
  });
}

void Reinitializer::apply(DenseField<float>& phi, const SolidBoundary* solids) {
  solids_ = solids;
  markInterface(phi, solids);
  if (solids) markBesideWalls(phi);
  layers_.grow(kLayers);
  markKinks(phi, kinks_);
  plantSeeds(phi);
  for (int layer = 1; layer <= kLayers; ++layer) spreadLayer(layer, true), spreadLayer(layer, false);
  for (int pass = 0; pass < kFinalPasses; ++pass)
    for (int layer = 1; layer <= kLayers; ++layer) spreadLayer(layer, false);
  measure(phi);
  fillGhostLayers(phi);
}

}  // namespace spume::fluid
