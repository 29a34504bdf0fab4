#include <gtest/gtest.h>

#include <numbers>

#include "fluid/level_set_advection.h"
#include "fluid/velocity_advection.h"
#include "tests/support/fluid_fields.h"

namespace spume::fluid {
namespace {

using namespace test;
constexpr double kPi = std::numbers::pi;

/// Largest error of phi = a cos(2 pi x) sin(2 pi y) carried along for `time` by a uniform wind, away from the
/// sides.
double transportError(LevelSetTransport transport, int n, double dt, int steps) {
  const GridSpec grid = unitCube(n);
  const Eigen::Vector3d wind(0.7, -0.4, 0.2);
  const double amplitude = 0.04;  // inside the band on every grid used, so that all cells move
  const auto wave = [&](const Eigen::Vector3d& x) {
    return amplitude * std::cos(2 * kPi * x.x()) * std::sin(2 * kPi * x.y());
  };
  DenseField<float> phi = levelSet(grid, wave);
  const MacVelocity velocity = macField(grid, [&](const auto&) { return wind; });
  LevelSetAdvection advection(grid);
  for (int step = 0; step < steps; ++step) advection.advance(transport, velocity, dt, phi);
  double worst = 0;
  forEachInner(grid.cells, n * 3 / 8, [&](int i, int j, int k) {
    const double exact = wave(grid.cellCentre(i, j, k) - dt * steps * wind);
    worst = std::max(worst, std::abs(phi(i, j, k) - exact) / amplitude);
  });
  return worst;
}

TEST(LevelSetAdvection, Weno5IsOfFifthOrderInSpace) {
  // dt ~ dx^(5/3) makes the third-order time error fall as fast; halving dx then gains 32, of which the flat
  // parts of the wave, where the weights of Jiang and Peng lose an order, may cost a half.
  const double coarse = transportError(LevelSetTransport::weno5, 16, 0.01, 4);
  const double fine = transportError(LevelSetTransport::weno5, 32, 0.01 / std::pow(2, 5.0 / 3), 13);
  EXPECT_GT(std::log2(coarse / fine), 4);
}

TEST(LevelSetAdvection, SemiLagrangianIsOfThirdOrderPerStepAtFixedCfl) {
  // Each step interpolates with an error ~ dx^4 (cubic), and there are ~ 1/dx of them.
  const double coarse = transportError(LevelSetTransport::semiLagrangian, 16, 0.02, 3);
  const double fine = transportError(LevelSetTransport::semiLagrangian, 32, 0.01, 6);
  EXPECT_GT(std::log2(coarse / fine), 2.7);
}

TEST(LevelSetAdvection, MovesWithTheWind) {
  const GridSpec grid = unitCube(32);
  for (const LevelSetTransport transport : {LevelSetTransport::semiLagrangian, LevelSetTransport::weno5}) {
    DenseField<float> phi =
        levelSet(grid, [](const auto& x) { return (x - Eigen::Vector3d(0.4, 0.5, 0.5)).norm() - 0.2; });
    const MacVelocity velocity = macField(grid, [](const auto&) { return Eigen::Vector3d(1, 0, 0); });
    LevelSetAdvection(grid).advance(transport, velocity, 2 * grid.dx, phi);
    // The surface was at x = 0.6; linear in phi between two cells.
    const double x = 0.6 + 2 * grid.dx;
    const int i = static_cast<int>(x / grid.dx - 0.5);
    const float a = 0.5f * (phi(i, 15, 15) + phi(i, 16, 16)),
                b = 0.5f * (phi(i + 1, 15, 15) + phi(i + 1, 16, 16));
    const double crossing = (i + 0.5 + a / (a - b)) * grid.dx;
    EXPECT_NEAR(crossing, x,
                0.05 * grid.dx);  // the four cells around the axis: sagitta 0.5 dx^2/(2 R) = 0.04 dx
  }
}

/// Error of the exact solution u = U + a sin(2 pi (y - V t)), v = V of u_t + u . grad u = 0.
double shearError(VelocityAdvection scheme, int n, double time) {
  const GridSpec grid{{n, n, 4}, 1.0 / n, Eigen::Vector3d::Zero()};
  const double U = 0.3, V = 0.5, a = 0.2;
  const auto flow = [&](const Eigen::Vector3d& x, double t) {
    return Eigen::Vector3d(U + a * std::sin(2 * kPi * (x.y() - V * t)), V, 0.1);
  };
  MacVelocity u = macField(grid, [&](const auto& x) { return flow(x, 0); });
  const DenseField<float> phi(grid.cells, -1.0f);
  const int steps = n / 8;  // CFL 2
  VelocityAdvector advector(grid);
  for (int step = 0; step < steps; ++step) advector.advance(scheme, phi, time / steps, u);
  double sum = 0;
  int count = 0;
  for (int j = n / 2; j < n * 3 / 4; ++j) {
    const Eigen::Vector3d x = grid.faceCentre(0, n / 2, j, 2);
    sum += std::abs(u[0](n / 2, j, 2) - flow(x, time).x());
    ++count;
    EXPECT_NEAR(u[1](n / 2, j, 2), V, 1e-5);
  }
  return sum / count;
}

TEST(VelocityAdvector, MacCormackIsOfSecondOrder) {
  const double coarse = shearError(VelocityAdvection::macCormack, 32, 0.23);
  const double fine = shearError(VelocityAdvection::macCormack, 64, 0.23);
  EXPECT_GT(std::log2(coarse / fine), 1.8);
}

TEST(VelocityAdvector, SemiLagrangianIsOfFirstOrder) {
  const double coarse = shearError(VelocityAdvection::semiLagrangian, 32, 0.23);
  const double fine = shearError(VelocityAdvection::semiLagrangian, 64, 0.23);
  EXPECT_GT(std::log2(coarse / fine), 0.8);
  EXPECT_LT(shearError(VelocityAdvection::macCormack, 64, 0.23), 0.5 * fine);
}

TEST(VelocityAdvector, LeavesUniformFlowAlone) {
  const GridSpec grid = unitCube(16);
  MacVelocity u = macField(grid, [](const auto&) { return Eigen::Vector3d(1, -2, 0.5); });
  const DenseField<float> phi(grid.cells, -1.0f);
  VelocityAdvector(grid).advance(VelocityAdvection::macCormack, phi, 3 * grid.dx, u);
  forEachInner(grid.cells, 0, [&](int i, int j, int k) {
    EXPECT_FLOAT_EQ(u[0](i, j, k), 1);
    EXPECT_FLOAT_EQ(u[1](i, j, k), -2);
    EXPECT_FLOAT_EQ(u[2](i, j, k), 0.5f);
  });
}

TEST(VelocityAdvector, GivesTheSameBitsOnAnyNumberOfThreads) {
  const GridSpec grid = unitCube(24);
  const DenseField<float> phi = levelSet(grid, [](const auto& x) { return x.y() - 0.6; });
  const auto run = [&](int threads) {
    return onThreads(threads, [&] {
      MacVelocity u = macField(grid, [](const Eigen::Vector3d& x) {
        return Eigen::Vector3d(std::sin(7 * x.y()), std::cos(5 * x.z()), std::sin(6 * x.x()));
      });
      VelocityAdvector(grid).advance(VelocityAdvection::macCormack, phi, 2 * grid.dx, u);
      return u;
    });
  };
  const MacVelocity one = run(1), four = run(4);
  for (int a = 0; a < 3; ++a) EXPECT_TRUE(sameBits(one[a], four[a]));
}

}  // namespace
}  // namespace spume::fluid
