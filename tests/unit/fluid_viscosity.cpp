#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "fluid/level_set.h"
#include "fluid/viscosity.h"
#include "tests/support/fluid_fields.h"

namespace spume::fluid {
namespace {

using namespace test;
using std::numbers::pi;

constexpr double kDt = 0.02;
constexpr double kFloat = 1e-6;  // of velocities of 1 m/s, a few roundings

struct Stage {
  GridSpec grid;
  DomainWalls walls;
  SolidBoundary solids = buildSolidBoundary(grid, walls, {}, 0);
  FluidParams params;

  Stage(int n, const DomainWalls& w, double kinematic) : grid(unitCube(n)), walls(w) {
    params.viscosity = kinematic * params.density;
  }
  void apply(const DenseField<float>& phi, MacVelocity& u) {
    Viscosity(grid, params).apply(phi, solids, kDt, u);
  }
};

DenseField<float> full(const GridSpec& grid) { return DenseField<float>(grid.cells, -1.0f); }

/// Channel between two walls that hold the liquid: sin(pi y) is an eigenvector of the discrete operator, its
/// eigenvalue 4/dx^2 sin^2(pi dx/2). The open ends are free of shear, which the flow is not: what they do to
/// it falls by nu dt/dx^2 = 0.1 a cell, so that it is below the tolerance from kEnd cells on.
TEST(Viscosity, AChannelDecaysAtTheDiscreteRate) {
  constexpr int kEnd = 6;
  constexpr double kKinematic = 0.02;
  Stage stage(16, {{false, false, true, true, false, false}}, kKinematic);
  MacVelocity u =
      macField(stage.grid, [](const auto& x) { return Eigen::Vector3d(std::sin(pi * x.y()), 0, 0); });
  const MacVelocity u0 = u;
  stage.apply(full(stage.grid), u);
  const double dx = stage.grid.dx, rate = 4 / (dx * dx) * std::pow(std::sin(0.5 * pi * dx), 2);
  const double factor = 1 / (1 + kDt * kKinematic * rate);
  forEachInner(stage.grid.cells, 0, [&](int i, int j, int k) {
    if (std::min({i, 15 - i, k, 15 - k}) < kEnd) return;
    EXPECT_NEAR(u[0](i, j, k), factor * u0[0](i, j, k), kFloat);
    EXPECT_NEAR(u[1](i, j, k), 0, kFloat);
  });
}

/// Liquid at rest is drawn along by a layer that is held at 1 m/s, as by a nozzle that pours into it: with k
/// = nu dt/dx^2 the implicit step gives u_j = q^j at j cells from the layer, q + 1/q = 2 + 1/k.
TEST(Viscosity, LiquidAtRestIsDrawnAlongByWhatMoves) {
  constexpr int kTop = 15;
  constexpr double k = 0.1;
  Stage stage(16, {{false, false, true, true, false, false}}, k / (kDt * 16 * 16));
  MacVelocity u(stage.grid.cells);
  for (int i = 0; i <= 16; ++i)
    for (int l = 0; l < 16; ++l) stage.solids.prescribed[0](i, kTop, l) = 1, u[0](i, kTop, l) = 1;
  stage.apply(full(stage.grid), u);
  const double half = 1 + 0.5 / k, q = half - std::sqrt(half * half - 1);
  for (int j = 0; j <= kTop; ++j) EXPECT_NEAR(u[0](8, j, 8), std::pow(q, kTop - j), kFloat) << j;
  EXPECT_NEAR(u[1](8, 8, 8), 0, kFloat);
}

/// No face carries less than half a twentieth of a cell, so with k = nu dt/dx^2 = 0.01 Gershgorin's circles
/// bound the condition of the matrix by 1 + 32 k/0.025 = 14: log(2/1e-8)/2 sqrt(14) = 36 iterations.
TEST(Viscosity, FacesOfNextToNoLiquidDoNotSpoilTheSolve) {
  Stage stage(32, closedWalls(), 0.01 / (kDt * 32 * 32));
  const Eigen::Vector3d centre(0.51, 0.49, 0.503);
  const DenseField<float> phi =
      levelSet(stage.grid, [&](const auto& x) { return (x - centre).norm() - 0.37; });
  MacVelocity u = macField(stage.grid, [](const auto& x) {
    return Eigen::Vector3d(std::sin(40 * x.y()), std::cos(50 * x.z()), std::sin(60 * x.x()));
  });
  Viscosity viscosity(stage.grid, stage.params);
  viscosity.apply(phi, stage.solids, kDt, u);
  EXPECT_LE(viscosity.iterations(), 36);
}

/// With free slip the vortex sin(pi x) cos(pi y) keeps its shape between walls: sum of two such eigenvalues.
TEST(Viscosity, AVortexBetweenSlippingWallsDecaysAtTheDiscreteRate) {
  Stage stage(16, closedWalls(), 0.1);
  stage.params.noSlip = false;
  MacVelocity u = macField(stage.grid, [](const auto& x) {
    return Eigen::Vector3d(std::sin(pi * x.x()) * std::cos(pi * x.y()),
                           -std::cos(pi * x.x()) * std::sin(pi * x.y()), 0);
  });
  const MacVelocity u0 = u;
  stage.apply(full(stage.grid), u);
  const double dx = stage.grid.dx, rate = 8 / (dx * dx) * std::pow(std::sin(0.5 * pi * dx), 2);
  const double factor = 1 / (1 + kDt * 0.1 * rate);
  forEachInner(stage.grid.cells, 0, [&](int i, int j, int k) {
    for (int a = 0; a < 2; ++a) EXPECT_NEAR(u[a](i, j, k), factor * u0[a](i, j, k), kFloat);
  });
}

/// A free blob that turns like a rigid body has no stress, whatever the viscosity; so has one that flies.
TEST(Viscosity, LeavesRigidMotionAlone) {
  Stage stage(20, openWalls(), 50);
  const auto phi =
      levelSet(stage.grid, [](const auto& x) { return (x - Eigen::Vector3d(0.5, 0.47, 0.52)).norm() - 0.3; });
  MacVelocity u = macField(stage.grid, [](const auto& x) {
    return Eigen::Vector3d(0.3 - x.y() + 0.5 * x.z(), 0.2 + x.x(), -0.1 - 0.5 * x.x());
  });
  const MacVelocity u0 = u;
  stage.apply(phi, u);
  for (int a = 0; a < 3; ++a)
    forEachInner(stage.grid.cells, 0,
                 [&](int i, int j, int k) { EXPECT_NEAR(u[a](i, j, k), u0[a](i, j, k), 3 * kFloat); });
}

/// Stress acts between parts of the liquid only: the momentum of a free blob stays, its energy falls.
TEST(Viscosity, KeepsTheMomentumOfAFreeBody) {
  Stage stage(20, openWalls(), 0.2);
  const auto phi =
      levelSet(stage.grid, [](const auto& x) { return (x.array() - 0.5).abs().maxCoeff() - 0.3; });
  MacVelocity u = macField(stage.grid, [](const auto& x) {
    return Eigen::Vector3d(std::sin(9 * x.y()), std::cos(7 * x.x()), x.x() * x.y());
  });
  // The liquid of the control volume of each face.
  DenseField<float> fraction(stage.grid.cells);
  computeLiquidFraction(phi, stage.solids, static_cast<float>(stage.grid.dx), fraction);
  const auto sums = [&](const MacVelocity& v) {
    std::array<double, 4> sum{};
    for (int a = 0; a < 3; ++a)
      forEachInner(stage.grid.cells, 1, [&](int i, int j, int k) {
        const Eigen::Vector3i c(i, j, k);
        const double mass = 0.5 * (fraction(c) + fraction(c - Eigen::Vector3i::Unit(a)));
        sum[a] += mass * v[a](c);
        sum[3] += mass * v[a](c) * v[a](c);
      });
    return sum;
  };
  const auto before = sums(u);
  stage.apply(phi, u);
  const auto after = sums(u);
  for (int a = 0; a < 3; ++a) EXPECT_NEAR(after[a], before[a], 1e-4 * std::sqrt(before[3] * 1728));
  EXPECT_LT(after[3], 0.9 * before[3]);
}

TEST(Viscosity, OneAndFourThreadsGiveTheSameBits) {
  const auto run = [] {
    Stage stage(16, closedWalls(), 0.1);
    const auto phi = levelSet(stage.grid, [](const auto& x) { return x.y() - 0.6; });
    MacVelocity u = macField(stage.grid, [](const auto& x) {
      return Eigen::Vector3d(std::sin(9 * x.y()), std::cos(7 * x.x()), x.x() * x.y());
    });
    stage.apply(phi, u);
    return u;
  };
  const MacVelocity one = onThreads(1, run), four = onThreads(4, run);
  for (int a = 0; a < 3; ++a) EXPECT_TRUE(sameBits(one[a], four[a]));
}

}  // namespace
}  // namespace spume::fluid
