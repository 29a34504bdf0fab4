#include "fluid/level_set_advection.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "fluid/cubic_interpolation.h"
#include "fluid/kinks.h"
#include "fluid/level_set.h"
#include "fluid/parallel.h"
#include "fluid/sampling.h"

namespace spume::fluid {
namespace {

/// Largest max|u| dt/dx of one Runge-Kutta step of WENO5; its limit for three axes at once lies near 0.6.
constexpr double kWenoCfl = 0.5;
/// Cells between the zero set's furthest reach in a step and the end of the band that may stay unmoved.
constexpr double kBandMargin = 2;
/// Values farther from the surface than this are interpolated linearly [cells]: only those near it decide
/// where it is, the others are made distances again from them.
constexpr float kAccurateReach = 3;
/// Regulariser of the WENO smoothness measures, relative to the slope squared [Jiang, Peng 2000].
constexpr float kWenoEpsilon = 1e-6f;

/// Value of phi at a point in index units: cubic, limited to the eight values around it, or limited quadratic
/// at kinks.
float sampleSurface(const FieldView& f, const DenseField<float>& phi, const DenseField<std::uint8_t>& kinks,
                    float x, float y, float z) {
  const CellBase b = cellBase(f, x, y, z);
  const float* p = f.corner + b.offset;
  const int si = f.strideI, sj = f.strideJ;
  const int i = b.offset / si - kGhost, j = b.offset % si / sj - kGhost, k = b.offset % sj - kGhost;
  const bool inside = phi.contains(i, j, k);
  if (!inside) return sampleIndex(f, x, y, z);
  if (cubeIsKinked(kinks, i, j, k)) return limitedValue(p, si, sj, b.fx, b.fy, b.fz).value;
  const auto [low, high] =
      std::minmax({p[0], p[1], p[sj], p[sj + 1], p[si], p[si + 1], p[si + sj], p[si + sj + 1]});
  return std::clamp(cubicValue(p, si, sj, b.fx, b.fy, b.fz).value, low, high);
}

/// Largest speed of any component on the grid [m/s].
double maxSpeed(const MacVelocity& velocity) {
  double largest = 0;
  for (const DenseField<float>& component : velocity.axis) {
    const Eigen::Vector3i n = component.size();
    const auto slab = [&](int i) {
      float m = 0;
      for (int j = 0; j < n.y(); ++j)
        for (int k = 0; k < n.z(); ++k) m = std::max(m, std::abs(component(i, j, k)));
      return static_cast<double>(m);
    };
    largest =
        std::max(largest, reduceSlabs(n.x(), 0.0, slab, [](double a, double b) { return std::max(a, b); }));
  }
  return largest;
}

/// Departure point in cell units of the path that ends at (x, y, z): midpoint rule, kept inside the grid.
Velocity3f departure(const MacView& velocity, const Eigen::Vector3f& top, float cellsPerSpeed, float x,
                     float y, float z) {
  const auto inside = [](float value, float limit) { return std::min(std::max(value, 0.0f), limit); };
  const float half = 0.5f * cellsPerSpeed;
  const Velocity3f first = sampleVelocity(velocity, x, y, z);
  const Velocity3f mid =
      sampleVelocity(velocity, inside(x - half * first.x, top.x()), inside(y - half * first.y, top.y()),
                     inside(z - half * first.z, top.z()));
  return {inside(x - cellsPerSpeed * mid.x, top.x()), inside(y - cellsPerSpeed * mid.y, top.y()),
          inside(z - cellsPerSpeed * mid.z, top.z())};
}

/// Fifth-order WENO value of a derivative from five consecutive differences, upwind first [Jiang, Peng 2000].
float wenoDerivative(float a, float b, float c, float d, float e) {
  const auto square = [](float v) { return v * v; };
  const float s0 = 13.0f / 12 * square(a - 2 * b + c) + 0.25f * square(a - 4 * b + 3 * c);
  const float s1 = 13.0f / 12 * square(b - 2 * c + d) + 0.25f * square(b - d);
  const float s2 = 13.0f / 12 * square(c - 2 * d + e) + 0.25f * square(3 * c - 4 * d + e);
  const float w0 = 0.1f / square(kWenoEpsilon + s0);
  const float w1 = 0.6f / square(kWenoEpsilon + s1);
  const float w2 = 0.3f / square(kWenoEpsilon + s2);
  return (w0 * (2 * a - 7 * b + 11 * c) + w1 * (-b + 5 * c + 2 * d) + w2 * (2 * c + 5 * d - e)) /
         (6 * (w0 + w1 + w2));
}

/// Upwind derivative of p along stride s for a wind of speed u; p in units of the cell edge.
float upwindDerivative(const float* p, std::ptrdiff_t s, float u, float perDx) {
  const std::ptrdiff_t t = u > 0 ? s : -s;  // towards the wind's lee; the stencil leans the other way
  const float d0 = p[-2 * t] - p[-3 * t], d1 = p[-t] - p[-2 * t], d2 = p[0] - p[-t], d3 = p[t] - p[0],
              d4 = p[2 * t] - p[t];
  const float value = wenoDerivative(d0 * perDx, d1 * perDx, d2 * perDx, d3 * perDx, d4 * perDx);
  return u > 0 ? value : -value;
}

}  // namespace

LevelSetAdvection::LevelSetAdvection(const GridSpec& grid)
    : grid_(grid),
      start_(grid.cells),
      next_(grid.cells),
      rate_(grid.cells),
      centreU_(grid.cells),
      centreV_(grid.cells),
      centreW_(grid.cells),
      kinks_(grid.cells) {}

void LevelSetAdvection::advance(LevelSetTransport transport, const MacVelocity& velocity, double dt,
                                DenseField<float>& phi) {
  if (transport == LevelSetTransport::weno5)
    weno5(velocity, dt, phi);
  else
    semiLagrangian(velocity, dt, phi);
}

void LevelSetAdvection::semiLagrangian(const MacVelocity& velocity, double dt, DenseField<float>& phi) {
  fillGhostLayers(phi);
  markKinks(phi, kinks_);
  const MacView wind(velocity);
  const FieldView source(phi);
  const Eigen::Vector3f top = grid_.cells.cast<float>();
  const float cellsPerSpeed = static_cast<float>(dt / grid_.dx);
  const double cfl = maxSpeed(velocity) * dt / grid_.dx;
  // Cells the surface cannot reach stay as they are; when it may cross the whole band every cell moves.
  const bool wholeGrid = cfl * std::sqrt(3.0) + kBandMargin > kLevelSetBand;
  const float reach = wholeGrid ? 2 * kLevelSetBand : kLevelSetBand * (1 - 1e-5f);
  const float limit = reach * static_cast<float>(grid_.dx);
  const float nearby = kAccurateReach * static_cast<float>(grid_.dx);
  forEachRow(grid_.cells, [&](int i, int j) {
    for (int k = 0; k < grid_.cells.z(); ++k) {
      const float value = phi(i, j, k);
      if (std::abs(value) >= limit) {
        next_(i, j, k) = value;
        continue;
      }
      const Velocity3f x = departure(wind, top, cellsPerSpeed, i + 0.5f, j + 0.5f, k + 0.5f);
      const float linear = sampleCentred(source, x.x, x.y, x.z);
      next_(i, j, k) = std::abs(linear) > nearby
                           ? linear
                           : sampleSurface(source, phi, kinks_, x.x - 0.5f, x.y - 0.5f, x.z - 0.5f);
    }
  });
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
  const double cfl = maxSpeed(velocity) * dt / grid_.dx;
  const int steps = std::max(1, static_cast<int>(std::ceil(cfl / kWenoCfl)));
  const float h = static_cast<float>(dt / steps);
  fillGhostLayers(phi);
  for (int step = 0; step < steps; ++step) {
    start_ = phi;
    for (const float ofStart : {0.0f, 0.75f, 1.0f / 3}) {
      wenoRate(phi);
      combine(phi, ofStart, h);
    }
  }
}

}  // namespace spume::fluid
