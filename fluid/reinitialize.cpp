#include "fluid/reinitialize.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "fluid/level_set.h"
#include "fluid/parallel.h"

namespace spume::fluid {
namespace {

/// Distance of a point not reached yet [cells].
constexpr float kFar = 1e6f;
/// Layers of face-neighbour steps: along a space diagonal a step gains 1/sqrt(3) cells.
constexpr int kLayers = 10;
static_assert(kLayers * kLayers * 3 >= kLevelSetBand * kLevelSetBand * 8, "the band is not covered");
/// Passes inside a layer, for points that hang on others of their own layer, and over all layers at the end.
constexpr int kPassesInLayer = 2;
constexpr int kFinalPasses = 2;
/// A second difference above this [1 per cell, relative to the slope] is a kink, not a curvature: radius 1.7
/// cells.
constexpr float kKink = 0.6f;
/// The distance may exceed the one along the nearest grid line by this factor before it counts as a wrong
/// slope.
constexpr float kSlopeSlack = 1.3f;

/// Slope of phi along one axis at p: fourth-order central where phi is smooth, second-order beside a kink,
/// the steeper side at a kink, 0 at an extremum.
float axisSlope(const float* p, std::ptrdiff_t s, float scale) {
  const float plus = p[s] - p[0], minus = p[0] - p[-s];
  const float kink = kKink * scale;
  if (std::abs(plus - minus) > kink) {
    if (plus * minus <= 0) return 0;
    return std::abs(plus) > std::abs(minus) ? plus : minus;
  }
  const float central = 0.5f * (plus + minus);
  const float outerPlus = p[2 * s] - p[s], outerMinus = p[-s] - p[-2 * s];
  if (std::abs(outerPlus - plus) > kink || std::abs(minus - outerMinus) > kink) return central;
  return (8 * (plus + minus) - (outerPlus + plus + minus + outerMinus)) / 12;
}

/// Distance from p to the nearest crossing along the grid lines through it [cells], kFar if there is none.
float nearestCrossing(const float* p, const std::array<std::ptrdiff_t, 3>& stride) {
  float nearest = kFar;
  for (const std::ptrdiff_t s : stride)
    for (const float other : {p[s], p[-s]})
      if ((other < 0) != (p[0] < 0)) nearest = std::min(nearest, p[0] / (p[0] - other));
  return nearest;
}

/// Upwind term c (d - t)^2 of one axis of the eikonal equation.
struct UpwindTerm {
  float t, c;
};

/// Second-order upwind term along one axis on the side of sign `side` [Sethian 1999]; first order where the
/// second point does not lie further up.
UpwindTerm upwindTerm(const float* d, std::ptrdiff_t s, float side) {
  const float plus = side * d[s], minus = side * d[-s];
  const float near = std::min(plus, minus);
  const float next = side * (plus < minus ? d[2 * s] : d[-2 * s]);
  if (near >= kFar || next > near || next < near - 2) return {near, 1};
  return {near + std::min(near - next, 1.0f) / 3, 2.25f};
}

/// Solves sum c (d - t)^2 = 1 over the axes that lie upwind of the result.
float solveEikonal(std::array<UpwindTerm, 3> term) {
  std::sort(term.begin(), term.end(), [](const UpwindTerm& a, const UpwindTerm& b) { return a.t < b.t; });
  float a = 0, b = 0, c = -1, d = kFar;
  for (const UpwindTerm& axis : term) {
    if (axis.t >= d) break;
    a += axis.c;
    b += axis.c * axis.t;
    c += axis.c * axis.t * axis.t;
    const float root = b * b - a * c;
    if (root < 0) break;
    d = (b + std::sqrt(root)) / a;
  }
  return d;
}

}  // namespace

Reinitializer::Reinitializer(const GridSpec& grid)
    : grid_(grid), layers_(grid.cells), distance_(grid.cells) {}

void Reinitializer::markInterface(const DenseField<float>& phi, const SolidBoundary* solids) {
  const std::ptrdiff_t si = phi.stride(0), sj = phi.stride(1);
  DenseField<std::uint8_t>& marks = layers_.marks();
  forEachRow(grid_.cells, [&](int i, int j) {
    const float* p = &phi(i, j, 0);
    std::uint8_t* mark = &marks(i, j, 0);
    for (int k = 0; k < grid_.cells.z(); ++k) {
      const bool wet = p[k] < 0;
      const bool crossed = (wet != (p[k - si] < 0)) | (wet != (p[k + si] < 0)) | (wet != (p[k - sj] < 0)) |
                           (wet != (p[k + sj] < 0)) | (wet != (p[k - 1] < 0)) | (wet != (p[k + 1] < 0));
      mark[k] = crossed ? std::uint8_t{0} : LayerList::kUnreached;
    }
    if (!solids) return;
    const float* psi = &solids->psi(i, j, 0);
    for (int k = 0; k < grid_.cells.z(); ++k)
      if (psi[k] <= 0) mark[k] = LayerList::kBarred;
  });
}

void Reinitializer::fixInterface(const DenseField<float>& phi) {
  const std::array<std::ptrdiff_t, 3> stride{phi.stride(0), phi.stride(1), 1};
  const float dx = static_cast<float>(grid_.dx);
  const auto cells = layers_.layer(0);
  tbb::parallel_for(std::size_t{0}, cells.size(), [&](std::size_t n) {
    const float* p = phi.data() + cells[n];
    const float crossing = nearestCrossing(p, stride);
    // The slope the kink test is measured by: a distorted phi is as smooth as its distance.
    const float scale = std::max(std::abs(*p) / std::max(crossing, 0.1f), 0.25f * dx);
    float square = 0;
    for (const std::ptrdiff_t s : stride) {
      const float slope = axisSlope(p, s, scale);
      square += slope * slope;
    }
    float distance = std::abs(*p) / std::max(std::sqrt(square), 1e-12f * dx);
    if (distance > kSlopeSlack * crossing) distance = crossing;
    distance_.data()[cells[n]] = *p < 0 ? -distance : distance;
  });
}

void Reinitializer::growLayer(int layer) {
  const std::ptrdiff_t si = distance_.stride(0), sj = distance_.stride(1);
  const auto cells = layers_.layer(layer);
  update_.resize(std::max(update_.size(), cells.size()));
  float* data = distance_.data();
  tbb::parallel_for(std::size_t{0}, cells.size(), [&](std::size_t n) {
    const float* d = data + cells[n];
    const float side = std::signbit(*d) ? -1.0f : 1.0f;
    const float value =
        solveEikonal({upwindTerm(d, si, side), upwindTerm(d, sj, side), upwindTerm(d, 1, side)});
    update_[n] = side * std::min(value, kFar);
  });
  tbb::parallel_for(std::size_t{0}, cells.size(), [&](std::size_t n) { data[cells[n]] = update_[n]; });
}

void Reinitializer::restoreSigns(DenseField<float>& phi) const {
  const float dx = static_cast<float>(grid_.dx);
  const float band = kLevelSetBand;
  forEachRow(grid_.cells, [&](int i, int j) {
    const float* d = &distance_(i, j, 0);
    const std::uint8_t* mark = &layers_.marks()(i, j, 0);
    float* p = &phi(i, j, 0);
    for (int k = 0; k < grid_.cells.z(); ++k)
      p[k] = mark[k] == LayerList::kBarred ? p[k] : dx * std::clamp(d[k], -band, band);
  });
}

void Reinitializer::apply(DenseField<float>& phi, const SolidBoundary* solids) {
  markInterface(phi, solids);
  layers_.grow(kLayers);
  const std::ptrdiff_t count = phi.count();
  tbb::parallel_for(std::ptrdiff_t{0}, phi.size().x() + std::ptrdiff_t{2 * kGhost}, [&](std::ptrdiff_t i) {
    const std::ptrdiff_t from = i * phi.stride(0), to = std::min(from + phi.stride(0), count);
    for (std::ptrdiff_t n = from; n < to; ++n) distance_.data()[n] = phi.data()[n] < 0 ? -kFar : kFar;
  });
  fixInterface(phi);
  for (int layer = 1; layer <= kLayers; ++layer)
    for (int pass = 0; pass < kPassesInLayer; ++pass) growLayer(layer);
  for (int pass = 0; pass < kFinalPasses; ++pass)
    for (int layer = 1; layer <= kLayers; ++layer) growLayer(layer);
  restoreSigns(phi);
  fillGhostLayers(phi);
}

}  // namespace spume::fluid
