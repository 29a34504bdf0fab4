#include "fluid/level_set.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "fluid/parallel.h"
#include "fluid/plane_fraction.h"
#include "fluid/sampling.h"

namespace spume::fluid {
namespace {

int reflect(int i, int n) {
  const int inside = i < 0 ? -1 - i : i >= n ? 2 * n - 1 - i : i;
  return std::clamp(inside, 0, n - 1);
}

int nearest(int i, int n) { return std::clamp(i, 0, n - 1); }

/// Fills all ghosts from `source(i, n)`, the inner index that a ghost index copies.
template <typename Source>
void fillGhosts(DenseField<float>& f, const Source& source) {
  const Eigen::Vector3i n = f.size();
  const std::ptrdiff_t rowLength = n.z() + 2 * kGhost;
  std::array<int, kGhost + 1> before, after;
  for (int g = 1; g <= kGhost; ++g) before[g] = source(-g, n.z()), after[g] = source(n.z() - 1 + g, n.z());
  forEachRow(n, [&, before, after](int i, int j) {
    float *row = &f(i, j, 0), *end = row + n.z() - 1;
    for (int g = 1; g <= kGhost; ++g) row[-g] = row[before[g]], end[g] = row[after[g]];
  });
  const auto copyRow = [&](int i, int j, int fromI, int fromJ) {
    std::copy_n(&f(fromI, fromJ, -kGhost), rowLength, &f(i, j, -kGhost));
  };
  for (int i = 0; i < n.x(); ++i)
    for (int g = 1; g <= kGhost; ++g) {
      copyRow(i, -g, i, source(-g, n.y()));
      copyRow(i, n.y() - 1 + g, i, source(n.y() - 1 + g, n.y()));
    }
  for (int g = 1; g <= kGhost; ++g)
    for (int j = -kGhost; j < n.y() + kGhost; ++j) {
      copyRow(-g, j, source(-g, n.x()), j);
      copyRow(n.x() - 1 + g, j, source(n.x() - 1 + g, n.x()), j);
    }
}

/// Gradient of psi per cell [-], one-sided at the domain faces (psi need not have ghosts).
Eigen::Vector3f wallNormal(const DenseField<float>& psi, float dx, int i, int j, int k) {
  Eigen::Vector3f gradient;
  const Eigen::Vector3i cell(i, j, k);
  for (int a = 0; a < 3; ++a) {
    Eigen::Vector3i low = cell, high = cell;
    low[a] = std::max(cell[a] - 1, 0);
    high[a] = std::min(cell[a] + 1, psi.size()[a] - 1);
    const int span = std::max(high[a] - low[a], 1);
    gradient[a] = (psi(high) - psi(low)) / (static_cast<float>(span) * dx);
  }
  return gradient;
}

}  // namespace

void fillGhostLayers(DenseField<float>& field) { fillGhosts(field, reflect); }

void fillGhostLayers(MacVelocity& velocity) {
  for (DenseField<float>& component : velocity.axis) fillGhosts(component, nearest);
}

void initialiseLevelSet(const GridSpec& grid, const std::function<double(const Eigen::Vector3d&)>& phi0,
                        DenseField<float>& phi) {
  if (phi.size() != grid.cells) phi = DenseField<float>(grid.cells);
  const double limit = kLevelSetBand * grid.dx;
  forEachCell(grid.cells, [&](int i, int j, int k) {
    phi(i, j, k) = static_cast<float>(std::clamp(phi0(grid.cellCentre(i, j, k)), -limit, limit));
  });
  fillGhostLayers(phi);
}

namespace {

/// Largest curvature term of the volume [phi per cell]: that of a drop of 2.7 cells radius. At kinks the
/// second difference is not a curvature and must not move the surface far.
constexpr float kMaxLaplacian = 0.75f;
/// Cells further from the surface than this are full or empty [cells]: half a diagonal and a margin.
constexpr float kUncutDistance = 1;
/// Columns per side along which a cell cut by wall and surface is integrated.
constexpr int kColumns = 4;

float laplacian(const float* p, std::ptrdiff_t si, std::ptrdiff_t sj) {
  return p[si] + p[-si] + p[sj] + p[-sj] + p[1] + p[-1] - 6 * p[0];
}

/// The eight octants of a cell, side by side so that the sums over their corners vectorise: trilinear phi in
/// the middle of each and its change across the octant along each axis.
struct alignas(32) Octants {
  float value[8], gx[8], gy[8], gz[8];
};

/// Octant n leans towards the neighbours at +stride along x, y, z where bit 2, 1, 0 of n is set. Linear
/// interpolation between centres overstates the mean of phi over the cell by laplacian/12: `shift` takes that
/// out.
void findOctants(const float* p, std::ptrdiff_t si, std::ptrdiff_t sj, float shift,
                 Octants& __restrict octants) {
  alignas(32) float corner[8][8];  // [corner][octant]
  for (int n = 0; n < 8; ++n) {
    const std::ptrdiff_t di = n & 4 ? si : -si, dj = n & 2 ? sj : -sj, dk = n & 1 ? 1 : -1;
    const float* near[4] = {p, p + dj, p + di, p + di + dj};
    for (int c = 0; c < 4; ++c) corner[2 * c][n] = near[c][0], corner[2 * c + 1][n] = near[c][dk];
  }
  const float q = 0.25f;
  for (int n = 0; n < 8; ++n) {
    const float v000 = corner[0][n], v001 = corner[1][n], v010 = corner[2][n], v011 = corner[3][n];
    const float v100 = corner[4][n], v101 = corner[5][n], v110 = corner[6][n], v111 = corner[7][n];
    const float c00 = lerp(v000, v001, q), c01 = lerp(v010, v011, q);
    const float c10 = lerp(v100, v101, q), c11 = lerp(v110, v111, q);
    const float c0 = lerp(c00, c01, q), c1 = lerp(c10, c11, q);
    octants.value[n] = lerp(c0, c1, q) - shift;
    octants.gx[n] = 0.5f * (c1 - c0);
    octants.gy[n] = 0.5f * lerp(c01 - c00, c11 - c10, q);
    octants.gz[n] = 0.5f * lerp(lerp(v001 - v000, v011 - v010, q), lerp(v101 - v100, v111 - v110, q), q);
  }
}

/// Fraction of a cell that is liquid, from its value and those around it.
float liquidFractionAround(const float* p, std::ptrdiff_t si, std::ptrdiff_t sj, float dx) {
  if (std::abs(*p) > kUncutDistance * dx) return *p < 0 ? 1.0f : 0.0f;
  const float shift = std::clamp(laplacian(p, si, sj), -kMaxLaplacian * dx, kMaxLaplacian * dx) / 12;
  Octants octants;
  findOctants(p, si, sj, shift, octants);
  alignas(64) double wet[8];
  for (int n = 0; n < 8; ++n)
    wet[n] = planeFraction(octants.value[n], octants.gx[n], octants.gy[n], octants.gz[n]);
  double sum = 0;
  for (const double part : wet) sum += part;
  return static_cast<float>(sum / 8);
}

/// The interval of [-1/2, 1/2] on which value + slope s < 0.
struct Interval {
  double low, high;
};
Interval negativePart(double value, double slope) {
  if (std::abs(slope) < 1e-12) return value < 0 ? Interval{-0.5, 0.5} : Interval{0.5, 0.5};
  const double root = std::clamp(-value / slope, -0.5, 0.5);
  return slope > 0 ? Interval{-0.5, root} : Interval{root, 0.5};
}

Eigen::Vector3d centralSlope(const float* p, std::ptrdiff_t si, std::ptrdiff_t sj) {
  return 0.5 * Eigen::Vector3d(p[si] - p[-si], p[sj] - p[-sj], p[1] - p[-1]);
}

/// Liquid part of the free space of a cell that both a wall and the surface may cut: both as planes,
/// integrated exactly along columns across the wall.
double liquidShareOfCutCell(const float* phi, std::ptrdiff_t si, std::ptrdiff_t sj,
                            const SolidBoundary& solids, float dx, int i, int j, int k) {
  const double phi0 = phi[0], psi0 = solids.psi(i, j, k);
  const Eigen::Vector3d phiSlope = centralSlope(phi, si, sj);
  const Eigen::Vector3d psiSlope = dx * wallNormal(solids.psi, dx, i, j, k).cast<double>();
  int across;
  psiSlope.cwiseAbs().maxCoeff(&across);
  const int b = (across + 1) % 3, c = (across + 2) % 3;
  double liquid = 0, free = 0;
  for (int m = 0; m < kColumns * kColumns; ++m) {
    const double sb = (m / kColumns + 0.5) / kColumns - 0.5, sc = (m % kColumns + 0.5) / kColumns - 0.5;
    const Interval wet = negativePart(phi0 + sb * phiSlope[b] + sc * phiSlope[c], phiSlope[across]);
    const Interval open = negativePart(-psi0 - sb * psiSlope[b] - sc * psiSlope[c], -psiSlope[across]);
    free += open.high - open.low;
    liquid += std::max(0.0, std::min(wet.high, open.high) - std::max(wet.low, open.low));
  }
  return free > 0 ? liquid / free : (phi0 < 0 ? 1.0 : 0.0);
}

float liquidOfCell(const DenseField<float>& phi, const SolidBoundary& solids, float dx, int i, int j, int k) {
  const float open = solids.cellFraction(i, j, k);
  if (open <= 0) return 0;
  const float value = phi(i, j, k);
  if (std::abs(value) > kUncutDistance * dx) return value < 0 ? open : 0;
  const auto liquid = [&](const float* p, std::ptrdiff_t si, std::ptrdiff_t sj) {
    if (open >= 1) return liquidFractionAround(p, si, sj, dx);
    return static_cast<float>(open * liquidShareOfCutCell(p, si, sj, solids, dx, i, j, k));
  };
  if (!(solids.sides.guard(i, j, k) & WallSides::kBeside))
    return liquid(&phi(i, j, k), phi.stride(0), phi.stride(1));
  const WallSides::Block own = solids.sides.read(phi, {i, j, k});
  return liquid(&own[WallSides::kCentre], 9, 3);
}

/// Liquid of a row's cells that the surface does not cut. On its own so that it vectorises.
[[gnu::noinline]] void uncutFraction(const float* __restrict phi, const float* __restrict open, int count,
                                     float* __restrict share) {
  for (int k = 0; k < count; ++k) share[k] = phi[k] < 0 ? open[k] : 0;
}

}  // namespace

float liquidFractionOfCell(const DenseField<float>& phi, float dx, int i, int j, int k) {
  return liquidFractionAround(&phi(i, j, k), phi.stride(0), phi.stride(1), dx);
}

void computeLiquidFraction(const DenseField<float>& phi, const SolidBoundary& solids, float dx,
                           DenseField<float>& fraction) {
  const Eigen::Vector3i n = phi.size();
  forEachRow(n, [&](int i, int j) {
    const float *p = &phi(i, j, 0), *open = &solids.cellFraction(i, j, 0);
    float* share = &fraction(i, j, 0);
    uncutFraction(p, open, n.z(), share);
    for (int k = 0; k < n.z(); ++k)
      if (std::abs(p[k]) <= kUncutDistance * dx) share[k] = liquidOfCell(phi, solids, dx, i, j, k);
  });
}

double liquidVolume(const GridSpec& grid, const DenseField<float>& phi, const SolidBoundary& solids) {
  const float dx = static_cast<float>(grid.dx);
  const auto slab = [&](int i) {
    double sum = 0;
    for (int j = 0; j < grid.cells.y(); ++j)
      for (int k = 0; k < grid.cells.z(); ++k) sum += liquidOfCell(phi, solids, dx, i, j, k);
    return sum;
  };
  const double cells = reduceSlabs(grid.cells.x(), 0.0, slab, [](double a, double b) { return a + b; });
  return cells * grid.cellVolume();
}

}  // namespace spume::fluid
