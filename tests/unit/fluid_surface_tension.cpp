#include <gtest/gtest.h>

#include <cmath>

#include "fluid/curvature.h"
#include "fluid/liquid_solver.h"
#include "fluid/projection.h"
#include "tests/support/fluid_fields.h"

namespace spume::fluid {
namespace {

using namespace test;

const Eigen::Vector3d kMiddle(0.51, 0.48, 0.505);

double ball(const Eigen::Vector3d& x, double radius) { return (x - kMiddle).norm() - radius; }

/// kappa = 2/r on every level set of a ball, to second order.
TEST(Curvature, OfABallConvergesAtSecondOrder) {
  const auto worst = [](int n) {
    const GridSpec grid = unitCube(n);
    const auto phi = levelSet(grid, [](const auto& x) { return ball(x, 0.3); });
    DenseField<float> kappa;
    computeCurvature(grid, WallSides(), phi, kappa);
    double error = 0;
    forEachInner(grid.cells, 0, [&](int i, int j, int k) {
      if (std::abs(phi(i, j, k)) > kCurvatureBand * grid.dx) return;
      error = std::max(error, std::abs(kappa(i, j, k) - 2 / (0.3 + phi(i, j, k))));
    });
    return error;
  };
  const double coarse = worst(24), fine = worst(48);
  EXPECT_LT(fine, 0.05);
  EXPECT_GT(std::log2(coarse / fine), 1.7);
}

/// A drop at rest without gravity: p = 2 sigma/r inside, and hardly any current [Laplace].
TEST(SurfaceTension, AStaticDropHoldsLaplacesPressure) {
  const GridSpec grid = unitCube(32);
  FluidParams params;
  params.gravity.setZero();
  params.surfaceTension = 5;
  const auto phi = levelSet(grid, [](const auto& x) { return ball(x, 0.3); });
  const SolidBoundary boundary = buildSolidBoundary(grid, openWalls(), {}, 0);
  MacVelocity u(grid.cells);
  MacField<float> gradient(grid.cells);
  Projection projection(grid, params);
  projection.project(phi, boundary, 1e-3, DenseField<float>(grid.cells, 0), u, gradient);
  const double laplace = 2 * params.surfaceTension / 0.3;
  EXPECT_NEAR(projection.pressure()(16, 15, 16) / laplace, 1, 2e-3);  // (dx/r)^2/6
}

/// The shared step is split to what explicit tension stands.
TEST(SurfaceTension, ShortensTheSubSteps) {
  FluidParams params;
  params.gravity.setZero();
  const LiquidSetup setup{unitCube(16), openWalls(), {}, {}};
  const auto phi0 = [](const auto& x) { return ball(x, 0.3); };
  EXPECT_EQ(LiquidSolver(params, setup, phi0).step(0.1).subSteps, 1);
  params.surfaceTension = 5;
  LiquidSolver solver(params, setup, phi0);
  const double limit = std::sqrt(1000 * std::pow(1.0 / 16, 3) / (4 * 3.14159265 * 5));
  EXPECT_NEAR(solver.stableDt(), limit, 1e-6 * limit);
  EXPECT_GE(solver.step(0.1).subSteps, static_cast<int>(0.1 / limit));
}

}  // namespace
}  // namespace spume::fluid
