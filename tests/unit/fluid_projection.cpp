#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <numbers>
#include <random>

#include "fluid/errors.h"
#include "fluid/projection.h"
#include "tests/fluid_scenery.h"

namespace spume::fluid {
namespace {

using namespace testing;

constexpr double kDt = 0.005;
constexpr double kStill = 1e-10;  // [m/s]; asked: 1e-8 (accuracy, F1). Round-off of dt g x 1/theta is 1e-15
constexpr double kFloat = 2e-7;   // relative, one rounding to float of phi or of the pressure

struct Solved {
  MacVelocity velocity;
  MacField<float> gradient;
  DenseField<float> pressure;
  MacField<std::uint8_t> valid;
  ProjectionReport report;
  double maxSpeed = 0;
};

Solved solve(const GridSpec& grid, const FluidParams& params, const DenseField<float>& phi,
             const SolidBoundary& boundary, MacVelocity velocity, float source = 0) {
  Projection projection(grid, params);
  Solved out{std::move(velocity), MacField<float>(grid.cells), {}, {}, {}};
  const DenseField<float> sources(grid.cells, source);
  out.report = projection.project(phi, boundary, kDt, sources, out.velocity, out.gradient);
  out.pressure = projection.pressure();
  out.valid = projection.valid();
  forEachFace(grid, [&](int a, const Eigen::Vector3i& c) {
    if (out.valid[a](c)) out.maxSpeed = std::max(out.maxSpeed, std::abs(double(out.velocity[a](c))));
  });
  return out;
}

TEST(Projection, PoolAtAnySubCellHeightRestsWithHydrostaticPressure) {
  const GridSpec grid = boxGrid(16);
  const FluidParams params;
  const SolidBoundary boundary = buildSolidBoundary(grid, DomainWalls{}, {}, 0);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> height(0.03, 0.13);
  for (int n = 0; n < 10; ++n) {
    const double h = height(random);
    const auto phi = sampleCells(grid, [&](const Eigen::Vector3d& x) { return x.y() - h; });
    const Solved out = solve(grid, params, phi, boundary, MacVelocity(grid.cells));
    EXPECT_LE(out.maxSpeed, kStill) << h;
    EXPECT_EQ(out.report.iterations, 0);
    for (int j = 0; grid.cellCentre(0, j, 0).y() < h; ++j) {
      const double exact = 9.8 * 1000 * (h - grid.cellCentre(5, j, 5).y());
      EXPECT_NEAR(out.pressure(5, j, 5), exact, kFloat * 9.8 * 1000 * 0.16) << h << " at " << j;
      if (j > 0) {
        EXPECT_NEAR(out.gradient[1](5, j, 5), -9800, kFloat * 9800);
      }
    }
  }
}

TEST(Projection, GravityMayPointAnywhereAndSolidsMayCutThePool) {
  const GridSpec grid = boxGrid(16);
  const SolidBoundary boundary =
      buildSolidBoundary(grid, sealed(), {sphere({0.0612, 0.0433, 0.0871}, 0.0317)}, 0);
  for (const Eigen::Vector3d& g :
       {Eigen::Vector3d(9.8, 0, 0), Eigen::Vector3d(0, 0, -9.8), Eigen::Vector3d(0, 0, 0)}) {
    FluidParams params;
    params.gravity = g;
    const auto phi = sampleCells(grid, [&](const Eigen::Vector3d& x) {
      return g.isZero() ? x.y() - 0.09 : 0.0213 - g.normalized().dot(x - Eigen::Vector3d::Constant(0.08));
    });
    EXPECT_LE(solve(grid, params, phi, boundary, MacVelocity(grid.cells)).maxSpeed, kStill);
  }
}

TEST(Projection, ATiltedPoolIsStillToTheRoundingOfPhi) {
  const GridSpec grid = boxGrid(16);
  FluidParams params;
  params.gravity = Eigen::Vector3d(3, -9, 1.7);
  const SolidBoundary boundary = buildSolidBoundary(grid, sealed(), {}, 0);
  const auto phi = sampleCells(grid, [&](const Eigen::Vector3d& x) {
    return 0.0121 - params.gravity.normalized().dot(x - Eigen::Vector3d::Constant(0.08));
  });
  // The surface is known to 6e-8 of phi, which is < 2 dx there, so pressure to rho g 1e-7 dx; its gradient
  // over the least theta of 0.01 dx moves a face by dt g 1e-5.
  EXPECT_LE(solve(grid, params, phi, boundary, MacVelocity(grid.cells)).maxSpeed, kDt * 9.8 * 1e-5);
}

TEST(Projection, PoolsAtDifferentLevelsRestSideBySide) {
  const GridSpec grid = boxGrid(16);
  const SolidObject wall{
      "wall", [](const Eigen::Vector3d& x, double) { return std::abs(x.x() - 0.083) - 0.012; }, {}, false};
  const SolidBoundary boundary = buildSolidBoundary(grid, DomainWalls{}, {wall}, 0);
  const auto phi =
      sampleCells(grid, [](const Eigen::Vector3d& x) { return x.y() - (x.x() < 0.083 ? 0.0517 : 0.1241); });
  EXPECT_LE(solve(grid, FluidParams{}, phi, boundary, MacVelocity(grid.cells)).maxSpeed, kStill);
}

TEST(Projection, AFreeBallFallsExactly) {
  const GridSpec grid = boxGrid(16);
  const FluidParams params;
  const SolidBoundary boundary = buildSolidBoundary(grid, DomainWalls{}, {}, 0);
  const auto phi = sampleCells(grid, [](const Eigen::Vector3d& x) {
    return (x - Eigen::Vector3d(0.081, 0.083, 0.077)).norm() - 0.04;
  });
  const Eigen::Vector3f before(0.25f, -0.5f, 0.125f);
  MacVelocity velocity(grid.cells);
  for (int a = 0; a < 3; ++a) velocity[a].fill(before[a]);
  const Solved out = solve(grid, params, phi, boundary, velocity);
  int faces = 0;
  forEachFace(grid, [&](int a, const Eigen::Vector3i& c) {
    if (!out.valid[a](c)) return;
    EXPECT_EQ(out.velocity[a](c), static_cast<float>(before[a] + kDt * params.gravity[a]));
    EXPECT_NEAR(out.gradient[a](c), 0, 1e-9 * 9800);
    ++faces;
  });
  EXPECT_GT(faces, 500);
}

/// u = grad of a cosine: the discrete Laplacian's eigenvalue -4 sin^2(pi/2n)/dx^2 gives the pressure in
/// closed form.
TEST(Projection, PressureOfACosineIsThatOfTheDiscreteEigenvalue) {
  const int n = 24;
  const GridSpec grid = boxGrid(n);
  FluidParams params;
  params.gravity.setZero();
  params.pressureTolerance = 1e-10;
  const SolidBoundary boundary = buildSolidBoundary(grid, sealed(), {}, 0);
  const double half = 0.5 * std::numbers::pi / n;
  MacVelocity velocity(grid.cells);
  forEachFace(grid, [&](int a, const Eigen::Vector3i& c) {
    if (a == 0) velocity[0](c) = static_cast<float>(std::sin(2 * half * c.x()));
  });
  const Solved out = solve(grid, params, DenseField<float>(grid.cells, -1), boundary, velocity);
  EXPECT_LE(out.maxSpeed, 1e-6);  // float velocities of size 1 go in
  const double amplitude = -params.density * grid.dx / kDt / (2 * std::sin(half));
  for (int i = 0; i < n; ++i)
    EXPECT_NEAR(out.pressure(i, 7, 3), amplitude * std::cos(half * (2 * i + 1)), 1e-5 * std::abs(amplitude));
}

TEST(Projection, DivergenceIsAtToleranceWithCutCellsAndSources) {
  const GridSpec grid = boxGrid(24);
  const FluidParams params;
  const SolidBoundary boundary =
      buildSolidBoundary(grid, DomainWalls{}, {sphere({0.0612, 0.0433, 0.0871}, 0.0317)}, 0);
  const auto phi = sampleCells(grid, [](const Eigen::Vector3d& x) {
    return std::min(x.y() - 0.0714, (x - Eigen::Vector3d(0.08, 0.12, 0.08)).norm() - 0.02);
  });
  for (float source : {0.0f, 0.3f}) {
    const Solved out = solve(grid, params, phi, boundary, randomVelocity(grid, 0.5, 3), source);
    EXPECT_LE(out.report.residual, params.pressureTolerance);
    EXPECT_GT(out.report.iterations, 0);
    // Right-hand sides reach 6 x 0.5 m/s; six velocities of up to 2 m/s rounded to float add 6 x 1.2e-7.
    EXPECT_LE(out.report.divergence, 3 * params.pressureTolerance + 1e-6);
  }
}

TEST(Projection, ASolidMovingThroughAFullBoxTellsWhatItCouldNotBalance) {
  const GridSpec grid = boxGrid(16);
  const FluidParams params;
  const SolidObject piston{"piston", [](const Eigen::Vector3d& x, double) { return x.x() - 0.0437; },
                           [](const Eigen::Vector3d&, double) { return Eigen::Vector3d(0.2, 0, 0); }, true};
  const SolidBoundary boundary = buildSolidBoundary(grid, sealed(), {piston}, 0);
  const Solved out =
      solve(grid, params, DenseField<float>(grid.cells, -1), boundary, MacVelocity(grid.cells));
  const int columns = 16 - 4;  // the piston's face lies in the fifth cell
  EXPECT_NEAR(out.report.incompatible, 0.2 / columns, 1e-6);
  double sum = 0;
  for (int i = 0; i < 16; ++i)
    for (int j = 0; j < 16; ++j)
      for (int k = 0; k < 16; ++k) sum += out.pressure(i, j, k);
  EXPECT_TRUE(std::isfinite(sum));
}

TEST(Projection, AnAirlessBoxStopsAnyFlowThroughItsWalls) {
  const GridSpec grid = boxGrid(16);
  const FluidParams params;
  const SolidBoundary boundary = buildSolidBoundary(grid, sealed(), {}, 0);
  const Solved out =
      solve(grid, params, DenseField<float>(grid.cells, -1), boundary, randomVelocity(grid, 0.5, 5));
  EXPECT_LE(out.report.divergence, 3 * params.pressureTolerance + 1e-6);
  EXPECT_LE(out.report.incompatible, 1e-12);
  forEachFace(grid, [&](int a, const Eigen::Vector3i& c) {
    if (c[a] == 0 || c[a] == 16) {
      EXPECT_EQ(out.velocity[a](c), 0);
    }
  });
  double sum = 0, largest = 0;
  for (int i = 0; i < 16; ++i)
    for (int j = 0; j < 16; ++j)
      for (int k = 0; k < 16; ++k) {
        sum += out.pressure(i, j, k);
        largest = std::max(largest, std::abs(double(out.pressure(i, j, k))));
      }
  EXPECT_LE(std::abs(sum), 4096 * kFloat * largest);  // mean 0
}

TEST(Projection, ResultDoesNotDependOnThreads) {
  const GridSpec grid = boxGrid(32);
  const SolidBoundary boundary =
      buildSolidBoundary(grid, DomainWalls{}, {sphere({0.0612, 0.0433, 0.0871}, 0.0317)}, 0);
  const auto phi =
      sampleCells(grid, [](const Eigen::Vector3d& x) { return x.y() - 0.09 - 0.02 * std::sin(50 * x.x()); });
  const auto run = [&](int threads) {
    tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    return solve(grid, FluidParams{}, phi, boundary, randomVelocity(grid, 0.5, 3));
  };
  const Solved one = run(1), four = run(4);
  EXPECT_EQ(one.report.iterations, four.report.iterations);
  forEachFace(grid,
              [&](int a, const Eigen::Vector3i& c) { EXPECT_EQ(one.velocity[a](c), four.velocity[a](c)); });
}

TEST(Projection, ThrowsWhenTheSolveDoesNotConvergeAndLeavesTheVelocity) {
  const GridSpec grid = boxGrid(16);
  FluidParams params;
  params.pressureIterations = 1;
  Projection projection(grid, params);
  const SolidBoundary boundary = buildSolidBoundary(grid, DomainWalls{}, {}, 0);
  const auto phi = sampleCells(grid, [](const Eigen::Vector3d& x) { return x.y() - 0.09; });
  const MacVelocity before = randomVelocity(grid, 0.5, 3);
  MacVelocity velocity = before;
  MacField<float> gradient(grid.cells);
  EXPECT_THROW(projection.project(phi, boundary, kDt, DenseField<float>(grid.cells), velocity, gradient),
               NumericalFailure);
  forEachFace(grid, [&](int a, const Eigen::Vector3i& c) { EXPECT_EQ(velocity[a](c), before[a](c)); });
}

}  // namespace
}  // namespace spume::fluid
