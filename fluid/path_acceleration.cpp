#include "fluid/path_acceleration.h"

#include "fluid/level_set.h"
#include "fluid/parallel.h"

namespace spume::fluid {
namespace {

/// Paths that end near the liquid began near it, within the stencil of an interpolation [layers of faces].
constexpr int kLayers = 3;

[[gnu::noinline]] void accelerationOfRow(const float* __restrict gradient, double gravity, double perDensity,
                                         int count, float* __restrict a) {
  for (int k = 0; k < count; ++k) a[k] = static_cast<float>(gravity - perDensity * gradient[k]);
}

[[gnu::noinline]] void clearGivenRow(const float* __restrict open, const std::uint8_t* __restrict given,
                                     int count, float* __restrict a) {
  for (int k = 0; k < count; ++k) a[k] = (open[k] <= 0) | (given[k] != 0) ? 0 : a[k];
}

/// Sets `a` to 0 on the faces whose velocity solids and inflows give.
void clearGiven(const SolidBoundary& solids, MacField<float>& a) {
  for (int axis = 0; axis < 3; ++axis)
    forEachRow(a[axis].size(), [&](int i, int j) {
      clearGivenRow(&solids.open[axis](i, j, 0), &solids.prescribed[axis](i, j, 0), a[axis].size().z(),
                    &a[axis](i, j, 0));
    });
  fillGhostLayers(a);
}

[[gnu::noinline]] void addRow(const float* __restrict u, const float* __restrict a, float time, int count,
                              float* __restrict sum) {
  for (int k = 0; k < count; ++k) sum[k] = u[k] + time * a[k];
}

/// sum = u + time a, ghosts included.
void add(const MacVelocity& u, const MacField<float>& a, float time, MacVelocity& sum) {
  for (int axis = 0; axis < 3; ++axis) {
    const int count = u[axis].size().z();
    forEachRow(u[axis].size(), [&](int i, int j) {
      addRow(&u[axis](i, j, 0), &a[axis](i, j, 0), time, count, &sum[axis](i, j, 0));
    });
  }
  fillGhostLayers(sum);
}

}  // namespace

void PathAcceleration::find(const LiquidState& state, const SolidBoundary& solids, const FluidParams& params,
                            VelocityExtrapolator& extrapolator, bool surfaceStands) {
  for (int axis = 0; axis < 3; ++axis) {
    const DenseField<float>& gradient = state.pressureGradient[axis];
    forEachRow(gradient.size(), [&](int i, int j) {
      accelerationOfRow(&gradient(i, j, 0), params.gravity[axis], 1 / params.density, gradient.size().z(),
                        &acceleration_[axis](i, j, 0));
    });
  }
  clearGiven(solids, acceleration_);
  extrapolator.apply(state.phi, solids, kLayers, acceleration_, surfaceStands);
  clearGiven(solids, acceleration_);
}

void PathAcceleration::advect(const DenseField<float>& phi, double dt, VelocityAdvector& advector,
                              MacVelocity& velocity) {
  const float half = static_cast<float>(0.5 * dt);
  add(velocity, acceleration_, half, carried_);
  advector.advance(VelocityAdvection::trapezoidal, phi, dt, velocity, carried_);
  add(carried_, acceleration_, -half, velocity);
}

}  // namespace spume::fluid
