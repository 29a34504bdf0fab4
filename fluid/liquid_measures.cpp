#include "fluid/liquid_measures.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fluid/parallel.h"
#include "fluid/sampling.h"

namespace spume::fluid {
namespace {

/// max() that keeps a NaN, so that a broken velocity cannot hide behind a large one.
double maxOrNan(double a, double b) { return std::isnan(a) || a > b ? a : b; }

/// Largest magnitude on the six faces of each wet cell of a row, NaN if one of them is none. On its own so
/// that it vectorises; comparisons alone would lose the NaN.
[[gnu::noinline]] float maxFaceSpeedOfRow(const float* __restrict phi, const float* __restrict u0,
                                          const float* __restrict u1, const float* __restrict v0,
                                          const float* __restrict v1, const float* __restrict w, int count) {
  float largest = 0;
  int broken = 0;
  for (int k = 0; k < count; ++k) {
    const float x = larger(std::abs(u0[k]), std::abs(u1[k])), y = larger(std::abs(v0[k]), std::abs(v1[k]));
    const float z = larger(std::abs(w[k]), std::abs(w[k + 1])), fastest = larger(larger(x, y), z);
    const float sum = u0[k] + u1[k] + v0[k] + v1[k] + w[k] + w[k + 1];
    const bool wet = phi[k] < 0;
    largest = larger(wet ? fastest : 0, largest);
    broken |= wet & (sum != sum) ? 1 : 0;
  }
  return broken ? std::numeric_limits<float>::quiet_NaN() : largest;
}

/// Largest magnitude of a row of faces, each between a cell and the one `back` before it, that lie in liquid.
[[gnu::noinline]] float maxInnerSpeedOfRow(const float* __restrict phi, std::ptrdiff_t back,
                                           const float* __restrict u, int count) {
  float largest = 0;
  for (int k = 0; k < count; ++k) largest = larger(phi[k] + phi[k - back] < 0 ? std::abs(u[k]) : 0, largest);
  return largest;
}

/// Square of the cell's velocity, each component the mean square of its two faces.
double meanSquareSpeed(const MacVelocity& velocity, int i, int j, int k) {
  double sum = 0;
  for (int a = 0; a < 3; ++a) {
    const Eigen::Vector3i next = Eigen::Vector3i(i, j, k) + Eigen::Vector3i::Unit(a);
    const double low = velocity[a](i, j, k), high = velocity[a](next);
    sum += 0.5 * (low * low + high * high);
  }
  return sum;
}

}  // namespace

double maxFaceSpeed(const DenseField<float>& phi, const MacVelocity& velocity) {
  const Eigen::Vector3i& n = phi.size();
  const auto slab = [&](int i) {
    double largest = 0;
    for (int j = 0; j < n.y(); ++j)
      largest = maxOrNan(
          maxFaceSpeedOfRow(&phi(i, j, 0), &velocity[0](i, j, 0), &velocity[0](i + 1, j, 0),
                            &velocity[1](i, j, 0), &velocity[1](i, j + 1, 0), &velocity[2](i, j, 0), n.z()),
          largest);
    return largest;
  };
  return reduceSlabs(n.x(), 0.0, slab, maxOrNan);
}

double maxInnerSpeed(const DenseField<float>& phi, const MacVelocity& velocity) {
  const auto slabOf = [&](int axis) {
    return [&, axis](int i) {
      const DenseField<float>& u = velocity[axis];
      float largest = 0;
      for (int j = 0; j < u.size().y(); ++j)
        largest =
            larger(maxInnerSpeedOfRow(&phi(i, j, 0), phi.stride(axis), &u(i, j, 0), u.size().z()), largest);
      return largest;
    };
  };
  float largest = 0;
  for (int axis = 0; axis < 3; ++axis)
    largest = larger(reduceSlabs(velocity[axis].size().x(), 0.0f, slabOf(axis), larger), largest);
  return largest;
}

Eigen::Vector3d cellVelocity(const MacVelocity& velocity, const Eigen::Vector3i& cell) {
  Eigen::Vector3d mean;
  for (int a = 0; a < 3; ++a)
    mean[a] = 0.5 * (velocity[a](cell) + velocity[a](cell + Eigen::Vector3i::Unit(a)));
  return mean;
}

void presentVelocity(const MacVelocity& earlier, const MacVelocity& later, double back,
                     MacVelocity& velocity) {
  const float before = static_cast<float>(back), after = static_cast<float>(1 - back);
  for (int a = 0; a < 3; ++a) {
    const Eigen::Vector3i& size = later[a].size();
    if (velocity[a].size() != size) velocity[a] = DenseField<float>(size);
    forEachRow(size, [&](int i, int j) {
      const float *old = &earlier[a](i, j, 0), *led = &later[a](i, j, 0);
      float* u = &velocity[a](i, j, 0);
      for (int k = 0; k < size.z(); ++k) u[k] = after * led[k] + before * old[k];
    });
  }
}

LiquidEnergy liquidEnergy(const GridSpec& grid, const DenseField<float>& fraction,
                          const MacVelocity& velocity, double density, const Eigen::Vector3d& gravity) {
  const Eigen::Vector3i& n = grid.cells;
  const auto slab = [&](int i) {
    Eigen::Vector2d sum(0, 0);
    for (int j = 0; j < n.y(); ++j)
      for (int k = 0; k < n.z(); ++k) {
        const double liquid = fraction(i, j, k);
        if (liquid == 0) continue;
        sum += liquid * Eigen::Vector2d(0.5 * meanSquareSpeed(velocity, i, j, k),
                                        -gravity.dot(grid.cellCentre(i, j, k)));
      }
    return sum;
  };
  const auto join = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return Eigen::Vector2d(a + b); };
  const Eigen::Vector2d sum = reduceSlabs(n.x(), Eigen::Vector2d(0, 0), slab, join);
  const double mass = density * grid.cellVolume();
  return {mass * sum[0], mass * sum[1]};
}

LiquidEnergy energyOf(const std::vector<Drop>& drops, double density, const Eigen::Vector3d& gravity) {
  LiquidEnergy sum;
  for (const Drop& drop : drops) {
    const double mass = density * drop.volume;
    sum.kinetic += 0.5 * mass * drop.velocity.squaredNorm();
    sum.potential -= mass * gravity.dot(drop.position);
  }
  return sum;
}

}  // namespace spume::fluid
