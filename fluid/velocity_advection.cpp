#include "fluid/velocity_advection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "fluid/level_set.h"
#include "fluid/parallel.h"
#include "fluid/sampling.h"

namespace spume::fluid {
namespace {

/// Faces within this many cells of the liquid are moved: the surface may advance there before the next
/// extrapolation, and the correcting pass reads the forward values one step further out.
constexpr float kReach = 2;
/// Points traced together: positions stay in the first-level cache and the loops over them vectorise.
/// One register of the widest kind, so that a run that only grazes the liquid drags few dry faces along.
constexpr int kChunk = 16;

/// Positions of a run of points along z [cells].
struct Points {
  alignas(64) float x[kChunk], y[kChunk], z[kChunk];
};

float inside(float value, float limit) {
  const float low = value > 0 ? value : 0;
  return low < limit ? low : limit;
}

/// One stage of a path: out = from + time u(at), kept inside the grid. Plain columns, so that it vectorises.
void moveAlong(const MacView& wind, const Eigen::Vector3f& top, float time, int count, const Points& from,
               const Points& at, Points& out) {
  const float topX = top.x(), topY = top.y(), topZ = top.z();
  const float *ax = at.x, *ay = at.y, *az = at.z, *fx = from.x, *fy = from.y, *fz = from.z;
  float* __restrict ox = out.x, * __restrict oy = out.y, * __restrict oz = out.z;
#pragma GCC ivdep
  for (int n = 0; n < count; ++n) {
    const Velocity3f u = sampleVelocity(wind, ax[n], ay[n], az[n]);
    ox[n] = inside(fx[n] + time * u.x, topX);
    oy[n] = inside(fy[n] + time * u.y, topY);
    oz[n] = inside(fz[n] + time * u.z, topZ);
  }
}

/// Moves `count` points along the wind for a time of `cellsPerSpeed` dx (negative: back) by the midpoint
/// rule.
void trace(const MacView& wind, const Eigen::Vector3f& top, float cellsPerSpeed, int count, Points& p) {
  Points middle, end;
  moveAlong(wind, top, 0.5f * cellsPerSpeed, count, p, p, middle);
  moveAlong(wind, top, cellsPerSpeed, count, p, middle, end);
  p = end;
}

/// Calls body(i, j, k, count) for runs of at most kChunk faces across `axis` whose row comes within `limit`
/// of the liquid.
template <typename Body>
void forEachWetRun(int axis, const DenseField<float>& phi, const DenseField<float>& faces, float limit,
                   const Body& body) {
  const std::ptrdiff_t back = phi.stride(axis);
  forEachRow(faces.size(), [&](int i, int j) {
    const float* p = &phi(i, j, 0);
    for (int k = 0; k < faces.size().z(); k += kChunk) {
      const int count = std::min(kChunk, faces.size().z() - k);
      float nearest = limit;
      for (int n = k; n < k + count; ++n) nearest = std::min(nearest, std::min(p[n], p[n - back]));
      if (nearest < limit) body(i, j, k, count);
    }
  });
}

/// Index-unit coordinates of a component are cell units less this.
std::array<float, 3> faceShift(int axis) {
  return {axis == 0 ? 0.0f : 0.5f, axis == 1 ? 0.0f : 0.5f, axis == 2 ? 0.0f : 0.5f};
}

/// The centres of a run of faces across `axis`.
void faceCentres(int axis, int i, int j, int k, int count, Points& p) {
  const std::array<float, 3> shift = faceShift(axis);
#pragma GCC ivdep
  for (int n = 0; n < count; ++n) {
    p.x[n] = static_cast<float>(i) + shift[0];
    p.y[n] = static_cast<float>(j) + shift[1];
    p.z[n] = static_cast<float>(k + n) + shift[2];
  }
}

/// Trilinear value of a component at a point in cell units, with the range of the eight values it comes from.
struct RangedValue {
  float value, low, high;
};
RangedValue sampleRanged(const FieldView& f, float x, float y, float z) {
  const CellBase b = cellBase(f, x, y, z);
  const float* p = f.corner + b.offset;
  const int si = f.strideI, sj = f.strideJ;
  const float a0 = p[0], a1 = p[1], b0 = p[sj], b1 = p[sj + 1];
  const float c0 = p[si], c1 = p[si + 1], d0 = p[si + sj], d1 = p[si + sj + 1];
  const float low =
      std::min(std::min(std::min(a0, a1), std::min(b0, b1)), std::min(std::min(c0, c1), std::min(d0, d1)));
  const float high =
      std::max(std::max(std::max(a0, a1), std::max(b0, b1)), std::max(std::max(c0, c1), std::max(d0, d1)));
  const float ab = lerp(lerp(a0, a1, b.fz), lerp(b0, b1, b.fz), b.fy);
  const float cd = lerp(lerp(c0, c1, b.fz), lerp(d0, d1, b.fz), b.fy);
  return {lerp(ab, cd, b.fx), low, high};
}

/// Largest magnitude of any component [m/s].
float largestValue(const MacVelocity& velocity) {
  const auto larger = [](float a, float b) { return std::max(a, b); };
  float largest = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const DenseField<float>& u = velocity[axis];
    const auto slab = [&](int i) {
      float value = 0;
      for (int j = 0; j < u.size().y(); ++j)
        for (int k = 0; k < u.size().z(); ++k) value = std::max(value, std::abs(u(i, j, k)));
      return value;
    };
    largest = std::max(largest, reduceSlabs(u.size().x(), 0.0f, slab, larger));
  }
  return largest;
}

}  // namespace

VelocityAdvector::VelocityAdvector(const GridSpec& grid)
    : grid_(grid), forward_(grid.cells), low_(grid.cells), high_(grid.cells), next_(grid.cells) {}

void VelocityAdvector::forwardPass(int axis, const DenseField<float>& phi, const MacVelocity& velocity,
                                   float cellsPerSpeed, float limit) {
  const MacView wind(velocity);
  const FieldView source(velocity[axis]);
  const Eigen::Vector3f top = grid_.cells.cast<float>();
  const std::array<float, 3> shift = faceShift(axis);
  forward_[axis] = velocity[axis];
  forEachWetRun(axis, phi, velocity[axis], limit, [&](int i, int j, int k, int count) {
    Points p;
    faceCentres(axis, i, j, k, count, p);
    trace(wind, top, -cellsPerSpeed, count, p);
    const float *x = p.x, *y = p.y, *z = p.z;
    const float shiftX = shift[0], shiftY = shift[1], shiftZ = shift[2];
    float *value = &forward_[axis](i, j, k), *low = &low_[axis](i, j, k), *high = &high_[axis](i, j, k);
#pragma GCC ivdep
    for (int n = 0; n < count; ++n) {
      const RangedValue v = sampleRanged(source, x[n] - shiftX, y[n] - shiftY, z[n] - shiftZ);
      value[n] = v.value;
      low[n] = v.low;
      high[n] = v.high;
    }
  });
}

void VelocityAdvector::correctingPass(int axis, const DenseField<float>& phi, const MacVelocity& velocity,
                                      float cellsPerSpeed, float limit) {
  const MacView wind(velocity);
  const FieldView forward(forward_[axis]);
  const Eigen::Vector3f top = grid_.cells.cast<float>();
  const std::array<float, 3> shift = faceShift(axis);
  next_[axis] = velocity[axis];
  forEachWetRun(axis, phi, velocity[axis], limit, [&](int i, int j, int k, int count) {
    Points p;
    faceCentres(axis, i, j, k, count, p);
    trace(wind, top, cellsPerSpeed, count, p);
    const float *start = &velocity[axis](i, j, k), *value = &forward_[axis](i, j, k);
    const float *low = &low_[axis](i, j, k), *high = &high_[axis](i, j, k);
    const float *x = p.x, *y = p.y, *z = p.z;
    const float shiftX = shift[0], shiftY = shift[1], shiftZ = shift[2];
    float* out = &next_[axis](i, j, k);
#pragma GCC ivdep
    for (int n = 0; n < count; ++n) {
      const float returned = sampleIndex(forward, x[n] - shiftX, y[n] - shiftY, z[n] - shiftZ);
      const float corrected = value[n] + 0.5f * (start[n] - returned);
      out[n] = std::min(std::max(corrected, low[n]), high[n]);
    }
  });
}

void VelocityAdvector::advance(VelocityAdvection scheme, const DenseField<float>& phi, double dt,
                               MacVelocity& velocity) {
  const float dx = static_cast<float>(grid_.dx);
  const float cellsPerSpeed = static_cast<float>(dt / grid_.dx);
  const bool corrected = scheme == VelocityAdvection::macCormack;
  // The correcting pass reads forward values as far out as a path is long, and one stencil more.
  const float path = corrected ? std::ceil(largestValue(velocity) * cellsPerSpeed) + 1 : 0;
  const float forwardLimit = (kReach + path) * dx;
  for (int axis = 0; axis < 3; ++axis) forwardPass(axis, phi, velocity, cellsPerSpeed, forwardLimit);
  if (corrected) {
    fillGhostLayers(forward_);
    for (int axis = 0; axis < 3; ++axis) correctingPass(axis, phi, velocity, cellsPerSpeed, kReach * dx);
    std::swap(velocity, next_);
  } else {
    std::swap(velocity, forward_);
  }
  fillGhostLayers(velocity);
}

}  // namespace spume::fluid
