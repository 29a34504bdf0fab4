#include "fluid/level_set_advection.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "fluid/cubic_interpolation.h"
#include "fluid/kinks.h"
#include "fluid/level_set.h"
#include "fluid/parallel.h"
#include "fluid/paths.h"
#include "fluid/sampling.h"
#include "fluid/upwind_gradient.h"

namespace spume::fluid {
namespace {

/// Largest max|u| dt/dx of one Runge-Kutta step of WENO5; its limit for three axes at once lies near 0.6.
constexpr double kWenoCfl = 0.5;
/// Values farther from the surface than this are interpolated linearly [cells]: only those near it decide
/// where it is, the others are made distances again from them.
constexpr float kAccurateReach = 3;

/// Value of phi at a point in index units: cubic, limited to the eight values around it, or limited quadratic
/// at kinks.
float sampleSurface(const FieldView& f, const DenseField<float>& phi, const DenseField<std::uint8_t>& kinks,
                    float x, float y, float z) {
  const CellBase b = innerCellBase(f, x, y, z);
  const float* p = f.corner + b.offset;
  const int si = f.strideI, sj = f.strideJ;
  const int i = static_cast<int>(x + kGhost) - kGhost, j = static_cast<int>(y + kGhost) - kGhost,
            k = static_cast<int>(z + kGhost) - kGhost;
  if (!phi.contains(i, j, k)) return interpolate(f, b);
  if (cubeIsKinked(kinks, i, j, k)) return limitedValue(p, si, sj, b.fx, b.fy, b.fz).value;
  const float low = smaller(smaller(smaller(p[0], p[1]), smaller(p[sj], p[sj + 1])),
                            smaller(smaller(p[si], p[si + 1]), smaller(p[si + sj], p[si + sj + 1])));
  const float high = larger(larger(larger(p[0], p[1]), larger(p[sj], p[sj + 1])),
                            larger(larger(p[si], p[si + 1]), larger(p[si + sj], p[si + sj + 1])));
  return std::clamp(cubicValue(p, si, sj, b.fx, b.fy, b.fz).value, low, high);
}

/// Upwind derivative of p along stride s for a wind of speed u; p in units of the cell edge.
float upwindDerivative(const float* p, std::ptrdiff_t s, float u, float perDx) {
  const std::ptrdiff_t t = u > 0 ? s : -s;  // towards the wind's lee; the stencil leans the other way
  const float d0 = p[-2 * t] - p[-3 * t], d1 = p[-t] - p[-2 * t], d2 = p[0] - p[-t], d3 = p[t] - p[0],
              d4 = p[2 * t] - p[t];
  const float value = wenoSlope(d0 * perDx, d1 * perDx, d2 * perDx, d3 * perDx, d4 * perDx);
  return u > 0 ? value : -value;
}

}  // namespace

LevelSetAdvection::LevelSetAdvection(const GridSpec& grid)
    : grid_(grid),
      moving_(grid.cells),
      start_(grid.cells),
      next_(grid.cells),
      rate_(grid.cells),
      centreU_(grid.cells),
      centreV_(grid.cells),
      centreW_(grid.cells),
      kinks_(grid.cells) {}

void LevelSetAdvection::advance(LevelSetTransport transport, const MacVelocity& velocity, double dt,
                                DenseField<float>& phi, const SolidBoundary* solids) {
  solids_ = solids && solids->sides.any() ? solids : nullptr;
  if (transport == LevelSetTransport::weno5)
    weno5(velocity, dt, phi);
  else
    semiLagrangian(velocity, dt, phi);
}

/// Value that comes to a cell within reach of a thin wall: on a way through open faces alone.
float LevelSetAdvection::valueBesideWall(const DenseField<float>& phi, const MacVelocity& velocity,
                                         float cellsPerSpeed, const Eigen::Vector3i& c) const {
  PathPoints centre, startWind, from;
  cellStarts(velocity, c.x(), c.y(), c.z(), centre, startWind);
  tracePaths(MacView(velocity), grid_.cells.cast<float>(), -cellsPerSpeed, centre, startWind, from);
  const Eigen::Vector3f start = c.cast<float>() + Eigen::Vector3f::Constant(0.5f);
  const Walk walk = walkThroughFaces(*solids_, c, start, {from.x[0], from.y[0], from.z[0]});
  const WallSides::Guard guard = solids_->sides.guard(walk.cell);
  if (guard & WallSides::kBeside) return solids_->sides.valueIn(phi, walk.cell, walk.at);
  const FieldView view(phi);
  const Eigen::Vector3f at = walk.at - Eigen::Vector3f::Constant(0.5f);
  const float linear = sampleInner(view, at.x(), at.y(), at.z());
  const bool plain = guard & WallSides::kNear || std::abs(linear) > kAccurateReach * grid_.dx;
  return plain ? linear : sampleSurface(view, phi, kinks_, at.x(), at.y(), at.z());
}

/// Does the cells within reach of a thin wall again, as their side of it sees them.
void LevelSetAdvection::keepSides(const DenseField<float>& phi, const MacVelocity& velocity, double dt,
                                  DenseField<float>& moved) const {
  if (!solids_) return;
  const float cellsPerSpeed = static_cast<float>(dt / grid_.dx);
  forEachRow(grid_.cells, [&](int i, int j) {
    const RowSpans::Span span = moving_.cells(i, j);
    for (int k = span.begin; k < span.end; ++k)
      if (solids_->sides.guard(i, j, k) & WallSides::kInReach && solids_->hasOpenFace(i, j, k))
        moved(i, j, k) = valueBesideWall(phi, velocity, cellsPerSpeed, {i, j, k});
  });
}

/// Cells that no path joins to the band stay as they are.
void LevelSetAdvection::findMoving(const DenseField<float>& phi, const MacVelocity& velocity, double dt) {
  const float limit = kLevelSetBand * (1 - 1e-5f) * static_cast<float>(grid_.dx);
  moving_.find(phi, [limit](float value) { return std::abs(value) < limit; });
  moving_.grow(static_cast<int>(std::ceil(largestSpeed(velocity) * dt / grid_.dx)) + 1);
}

void LevelSetAdvection::semiLagrangian(const MacVelocity& velocity, double dt, DenseField<float>& phi) {
  fillGhostLayers(phi);
  markKinks(phi, kinks_);
  const MacView wind(velocity);
  const FieldView source(phi);
  const Eigen::Vector3f top = grid_.cells.cast<float>();
  const float cellsPerSpeed = static_cast<float>(dt / grid_.dx);
  const float nearby = kAccurateReach * static_cast<float>(grid_.dx);
  findMoving(phi, velocity, dt);
  forEachRow(grid_.cells, [&](int i, int j) {
    const RowSpans::Span span = moving_.cells(i, j);
    RowSpans::copyOutside(span, &phi(i, j, 0), grid_.cells.z(), &next_(i, j, 0));
    for (int k = span.begin; k < span.end; k += kPathChunk) {
      PathPoints centre, startWind, from;
      cellStarts(velocity, i, j, k, centre, startWind);
      tracePaths(wind, top, -cellsPerSpeed, centre, startWind, from);
      alignas(64) float linear[kPathChunk];
      sampleRun(source, from, linear);
      float* out = &next_(i, j, k);
      for (int n = 0; n < std::min(kPathChunk, span.end - k); ++n)
        out[n] = std::abs(linear[n]) > nearby ? linear[n]
                                              : sampleSurface(source, phi, kinks_, from.x[n] - 0.5f,
                                                              from.y[n] - 0.5f, from.z[n] - 0.5f);
    }
  });
  keepSides(phi, velocity, dt, next_);
  phi.swap(next_);
  fillGhostLayers(phi);
}

void LevelSetAdvection::centreVelocity(const MacVelocity& velocity) {
  forEachCell(grid_.cells, [&](int i, int j, int k) {
    centreU_(i, j, k) = 0.5f * (velocity[0](i, j, k) + velocity[0](i + 1, j, k));
    centreV_(i, j, k) = 0.5f * (velocity[1](i, j, k) + velocity[1](i, j + 1, k));
    centreW_(i, j, k) = 0.5f * (velocity[2](i, j, k) + velocity[2](i, j, k + 1));
  });
}

void LevelSetAdvection::wenoRate(const DenseField<float>& phi) {
  const float perDx = static_cast<float>(1 / grid_.dx);
  const float limit = static_cast<float>(kLevelSetBand * (1 - 1e-5) * grid_.dx);
  const std::ptrdiff_t si = phi.stride(0), sj = phi.stride(1);
  forEachRow(grid_.cells, [&](int i, int j) {
    const float* p = &phi(i, j, 0);
    const float *u = &centreU_(i, j, 0), *v = &centreV_(i, j, 0), *w = &centreW_(i, j, 0);
    const float* start = &start_(i, j, 0);
    float* rate = &rate_(i, j, 0);
    for (int k = 0; k < grid_.cells.z(); ++k) {
      if (std::abs(start[k]) >= limit) {
        rate[k] = 0;
        continue;
      }
      rate[k] =
          -(u[k] * upwindDerivative(p + k, si, u[k], perDx) +
            v[k] * upwindDerivative(p + k, sj, v[k], perDx) + w[k] * upwindDerivative(p + k, 1, w[k], perDx));
    }
  });
}

void LevelSetAdvection::combine(DenseField<float>& phi, float ofStart, float dt) const {
  const float ofStage = 1 - ofStart;
  forEachRow(grid_.cells, [&](int i, int j) {
    float* p = &phi(i, j, 0);
    const float *start = &start_(i, j, 0), *rate = &rate_(i, j, 0);
    for (int k = 0; k < grid_.cells.z(); ++k) p[k] = ofStart * start[k] + ofStage * (p[k] + dt * rate[k]);
  });
  fillGhostLayers(phi);
}

void LevelSetAdvection::weno5(const MacVelocity& velocity, double dt, DenseField<float>& phi) {
  centreVelocity(velocity);
  const double cfl = largestSpeed(velocity) * dt / grid_.dx;
  const int steps = std::max(1, static_cast<int>(std::ceil(cfl / kWenoCfl)));
  const float h = static_cast<float>(dt / steps);
  fillGhostLayers(phi);
  if (solids_) next_ = phi, markKinks(phi, kinks_), findMoving(phi, velocity, dt);
  for (int step = 0; step < steps; ++step) {
    start_ = phi;
    for (const float ofStart : {0.0f, 0.75f, 1.0f / 3}) {
      wenoRate(phi);
      combine(phi, ofStart, h);
    }
  }
  keepSides(next_, velocity, dt, phi);
}

}  // namespace spume::fluid
