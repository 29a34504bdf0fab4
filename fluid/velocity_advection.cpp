#include "fluid/velocity_advection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "fluid/level_set.h"
#include "fluid/parallel.h"
#include "fluid/paths.h"
#include "fluid/sampling.h"

namespace spume::fluid {
namespace {

/// Faces within this many cells of the liquid are moved: the surface may advance there before the next
/// extrapolation, and the correcting pass reads the forward values one step further out.
constexpr float kReach = 2;
/// Faces with less liquid than this around them [cells] keep the forward pass's values: the error of going
/// there and back is measured in part in velocities beyond the surface, which are only continued there.
/// Corrected by it short waves at a surface otherwise at rest are fed for ever: neighbouring columns of cells
/// stood 0.35 dx apart, now 0.14. 1.5 cells would leave 0.07, and let streams lose energy to shorter steps.
constexpr float kUncorrected = 0.5f;

/// Index-unit coordinates of a component are cell units less this.
std::array<float, 3> faceShift(int axis) {
  return {axis == 0 ? 0.0f : 0.5f, axis == 1 ? 0.0f : 0.5f, axis == 2 ? 0.0f : 0.5f};
}

/// Calls body(i, j, k, count) for runs of at most kPathChunk of the faces across `axis` that `spans` holds,
/// and copies the others from one field to another.
template <typename Body>
void forEachRun(int axis, const RowSpans& spans, const DenseField<float>& from, DenseField<float>& to,
                const Body& body) {
  const int length = from.size().z();
  forEachRow(from.size(), [&](int i, int j) {
    const RowSpans::Span span = spans.faces(axis, i, j);
    RowSpans::copyOutside(span, &from(i, j, 0), length, &to(i, j, 0));
    for (int k = span.begin; k < span.end; k += kPathChunk) body(i, j, k, std::min(kPathChunk, span.end - k));
  });
}

/// Values of a run of points.
struct RunValues {
  alignas(64) float value[kPathChunk];
};

/// Trilinear values of a component at a run of points [cells], with the range of the eight values each comes
/// from.
void sampleRanged(const FieldView& f, const std::array<float, 3>& shift, const PathPoints& __restrict at,
                  float* __restrict value, float* __restrict low, float* __restrict high) {
  const float* p = f.corner;
  const float sx = shift[0], sy = shift[1], sz = shift[2];
  const int si = f.strideI, sj = f.strideJ;
  for (int n = 0; n < kPathChunk; ++n) {
    const CellBase b = innerCellBase(f, at.x[n] - sx, at.y[n] - sy, at.z[n] - sz);
    const int o = b.offset;
    const auto [a0, a1] = loadNeighbours(p, o);
    const auto [b0, b1] = loadNeighbours(p, o + sj);
    const auto [c0, c1] = loadNeighbours(p, o + si);
    const auto [d0, d1] = loadNeighbours(p, o + si + sj);
    low[n] = smaller(smaller(smaller(a0, a1), smaller(b0, b1)), smaller(smaller(c0, c1), smaller(d0, d1)));
    high[n] = larger(larger(larger(a0, a1), larger(b0, b1)), larger(larger(c0, c1), larger(d0, d1)));
    const float ab = lerp(lerp(a0, a1, b.fz), lerp(b0, b1, b.fz), b.fy);
    const float cd = lerp(lerp(c0, c1, b.fz), lerp(d0, d1, b.fz), b.fy);
    value[n] = lerp(ab, cd, b.fx);
  }
}

/// Adds half the error of going there and back to the forward values, within their range.
void correctRun(const FieldView& forward, const std::array<float, 3>& shift,
                const PathPoints& __restrict returned, const float* __restrict start,
                const float* __restrict value, const float* __restrict low, const float* __restrict high,
                float* __restrict out) {
  const float sx = shift[0], sy = shift[1], sz = shift[2];
  for (int n = 0; n < kPathChunk; ++n) {
    const float back = sampleInner(forward, returned.x[n] - sx, returned.y[n] - sy, returned.z[n] - sz);
    out[n] = smaller(larger(value[n] + 0.5f * (start[n] - back), low[n]), high[n]);
  }
}

/// Takes the forward values of a run of faces that have less than `depth` [m] of liquid around them. phi is
/// that of the cells above them, `back` before it that of those below.
void keepNearSurface(const float* __restrict phi, std::ptrdiff_t back, float depth,
                     const float* __restrict forward, int count, float* __restrict value) {
  for (int n = 0; n < count; ++n) value[n] = phi[n] + phi[n - back] > -2 * depth ? forward[n] : value[n];
}

}  // namespace

VelocityAdvector::VelocityAdvector(const GridSpec& grid)
    : grid_(grid),
      wet_(grid.cells),
      forwardSpans_(grid.cells),
      forward_(grid.cells),
      low_(grid.cells),
      high_(grid.cells),
      next_(grid.cells) {}

void VelocityAdvector::forwardPass(int axis, const MacVelocity& velocity, const MacVelocity& carried,
                                   float cellsPerSpeed) {
  const MacView wind(velocity);
  const FieldView source(carried[axis]);
  const Eigen::Vector3f top = grid_.cells.cast<float>();
  const std::array<float, 3> shift = faceShift(axis);
  forEachRun(axis, forwardSpans_, carried[axis], forward_[axis], [&](int i, int j, int k, int count) {
    PathPoints centre, startWind, from;
    faceStarts(velocity, axis, i, j, k, centre, startWind);
    tracePaths(wind, top, -cellsPerSpeed, centre, startWind, from);
    RunValues value, low, high;
    sampleRanged(source, shift, from, value.value, low.value, high.value);
    std::copy_n(value.value, count, &forward_[axis](i, j, k));
    std::copy_n(low.value, count, &low_[axis](i, j, k));
    std::copy_n(high.value, count, &high_[axis](i, j, k));
  });
}

void VelocityAdvector::correctingPass(int axis, const DenseField<float>& phi, const MacVelocity& velocity,
                                      const MacVelocity& carried, float cellsPerSpeed) {
  const MacView wind(velocity);
  const FieldView forward(forward_[axis]);
  const Eigen::Vector3f top = grid_.cells.cast<float>();
  const std::array<float, 3> shift = faceShift(axis);
  const float depth = kUncorrected * static_cast<float>(grid_.dx);
  forEachRun(axis, wet_, carried[axis], next_[axis], [&](int i, int j, int k, int count) {
    PathPoints centre, startWind, returned;
    faceStarts(velocity, axis, i, j, k, centre, startWind);
    tracePaths(wind, top, cellsPerSpeed, centre, startWind, returned);
    RunValues corrected;
    correctRun(forward, shift, returned, &carried[axis](i, j, k), &forward_[axis](i, j, k),
               &low_[axis](i, j, k), &high_[axis](i, j, k), corrected.value);
    keepNearSurface(&phi(i, j, k), phi.stride(axis), depth, &forward_[axis](i, j, k), count, corrected.value);
    std::copy_n(corrected.value, count, &next_[axis](i, j, k));
  });
}

void VelocityAdvector::advance(VelocityAdvection scheme, const DenseField<float>& phi, double dt,
                               const MacVelocity& velocity, MacVelocity& carried) {
  const float cellsPerSpeed = static_cast<float>(dt / grid_.dx);
  const bool corrected = scheme != VelocityAdvection::semiLagrangian;
  const float limit = kReach * static_cast<float>(grid_.dx);
  wet_.find(phi, [limit](float value) { return value < limit; });
  forwardSpans_ = wet_;
  // The correcting pass reads forward values as far out as a path is long, and one stencil more.
  if (corrected) forwardSpans_.grow(static_cast<int>(std::ceil(largestSpeed(velocity) * cellsPerSpeed)) + 1);
  for (int axis = 0; axis < 3; ++axis) forwardPass(axis, velocity, carried, cellsPerSpeed);
  if (corrected) {
    fillGhostLayers(forward_);
    for (int axis = 0; axis < 3; ++axis) correctingPass(axis, phi, velocity, carried, cellsPerSpeed);
    std::swap(carried, next_);
  } else {
    std::swap(carried, forward_);
  }
  fillGhostLayers(carried);
}

}  // namespace spume::fluid
