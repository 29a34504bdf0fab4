#include <gtest/gtest.h>

#include <cmath>

#include "fluid/liquid_solver.h"
#include "fluid/pocket_books.h"
#include "fluid/projection.h"
#include "tests/fluid_scenery.h"

namespace spume::fluid {
namespace {

using namespace testing;

constexpr double kDt = 0.005;

/// A cup upside down: a cylinder about the y axis through the middle of the box, open below.
SolidObject invertedCup(double rim, double lid, double inner, double wall) {
  return {"cup",
          [=](const Eigen::Vector3d& x, double) {
            const double r = std::hypot(x.x() - 0.08, x.z() - 0.08);
            const double outside = std::max({r - inner - wall, x.y() - lid - wall, rim - x.y()});
            const double cavity = std::max(r - inner, x.y() - lid);
            return std::max(outside, -cavity);
          },
          {},
          false};
}

double pressureAt(const DenseField<float>& pressure, const GridSpec& grid, const Eigen::Vector3d& x) {
  return pressure(grid.toCells(x).array().floor().cast<int>().matrix());
}

/// Still water over an inverted cup with air in it: nothing moves, the air carries the water's pressure at
/// its own level, and the water outside knows nothing of it.
TEST(ClosedPockets, RestUnderAnInvertedCupAtHydrostaticPressure) {
  const GridSpec grid = boxGrid(32);
  const double surface = 0.1237, inside = 0.0613;
  const SolidBoundary boundary =
      buildSolidBoundary(grid, DomainWalls{}, {invertedCup(0.04, 0.09, 0.03, 0.011)}, 0);
  const auto phi = sampleCells(grid, [&](const Eigen::Vector3d& x) {
    const double r = std::hypot(x.x() - 0.08, x.z() - 0.08);
    return r < 0.0355 && x.y() < 0.0955 ? x.y() - inside : x.y() - surface;
  });
  AirPockets pockets;
  pockets.find(grid, phi, boundary);
  ASSERT_EQ(pockets.pockets().size(), 1u);
  Projection projection(grid, {});
  MacVelocity velocity(grid.cells);
  MacField<float> gradient(grid.cells);
  const HeldPockets held{pockets.label(), pockets.pockets(), {0}};
  projection.project(phi, boundary, kDt, DenseField<float>(grid.cells, 0), velocity, gradient, &held);
  double fastest = 0;
  forEachFace(grid, [&](int a, const Eigen::Vector3i& c) {
    fastest = std::max(fastest, std::abs(double(velocity[a](c))));
  });
  EXPECT_LT(fastest, 1e-10);  // [m/s]; asked: 1e-8
  const double gas = 1000 * 9.8 * (surface - inside);
  EXPECT_NEAR(pressureAt(projection.pressure(), grid, {0.081, 0.08, 0.081}), gas, 1e-6 * gas);
  EXPECT_NEAR(pressureAt(projection.pressure(), grid, {0.0125, 0.05, 0.0125}),
              1000 * 9.8 * (surface - grid.cellCentre(0, 10, 0).y() + 0.0), 0.01 * gas);
}

/// A ball of air in water at random velocities: after the projection no volume flows through its surface, or
/// as much as is asked for.
TEST(ClosedPockets, TheFlowThroughTheSurfaceIsTheGrowthAskedFor) {
  const GridSpec grid = boxGrid(24);
  const SolidBoundary boundary = buildSolidBoundary(grid, DomainWalls{}, {}, 0);
  const auto phi = sampleCells(grid, [](const Eigen::Vector3d& x) {
    return std::max(x.y() - 0.12, 0.0271 - (x - Eigen::Vector3d(0.07, 0.06, 0.08)).norm());
  });
  AirPockets pockets;
  pockets.find(grid, phi, boundary);
  ASSERT_EQ(pockets.pockets().size(), 1u);
  FluidParams params;
  params.pressureTolerance = 1e-9;
  for (const double growth : {0.0, 3e-5}) {
    Projection projection(grid, params);
    MacVelocity velocity = randomVelocity(grid, 0.3, 5);
    MacField<float> gradient(grid.cells);
    const HeldPockets held{pockets.label(), pockets.pockets(), {growth}};
    projection.project(phi, boundary, kDt, DenseField<float>(grid.cells, 0), velocity, gradient, &held);
    double flow = 0, faces = 0;
    forEachFace(grid, [&](int a, const Eigen::Vector3i& c) {
      const Eigen::Vector3i low = c - Eigen::Vector3i::Unit(a);
      if ((c.array() >= grid.cells.array()).any() || low[a] < 0) return;
      const int into = (pockets.label()(c) >= 0) - (pockets.label()(low) >= 0);
      flow -= into * double(velocity[a](c)) * grid.dx * grid.dx;
      faces += std::abs(into);
    });
    EXPECT_NEAR(flow, growth, 1e-7 * 0.3 * faces * grid.dx * grid.dx) << growth;  // float velocities
  }
}

/// Without any open air the largest pocket serves as the reference; the others still keep their gas.
TEST(ClosedPockets, ASealedTankWithTwoBubblesIsSolved) {
  const GridSpec grid = boxGrid(24);
  DomainWalls open;  // the tank is a solid shell in a domain open to the air
  const SolidObject shell{"shell",
                          [](const Eigen::Vector3d& x, double) {
                            const double out = (x - Eigen::Vector3d::Constant(0.08)).cwiseAbs().maxCoeff();
                            return std::max(out - 0.075, 0.061 - out);
                          },
                          {},
                          false};
  const SolidBoundary boundary = buildSolidBoundary(grid, open, {shell}, 0);
  const auto phi = sampleCells(grid, [](const Eigen::Vector3d& x) {
    const double balls = std::max(0.019 - (x - Eigen::Vector3d(0.06, 0.08, 0.08)).norm(),
                                  0.015 - (x - Eigen::Vector3d(0.11, 0.08, 0.08)).norm());
    return std::max((x - Eigen::Vector3d::Constant(0.08)).cwiseAbs().maxCoeff() - 0.066, balls);
  });
  AirPockets pockets;
  pockets.find(grid, phi, boundary);
  ASSERT_EQ(pockets.pockets().size(), 2u);
  Projection projection(grid, {});
  MacVelocity velocity = randomVelocity(grid, 0.3, 5);
  MacField<float> gradient(grid.cells);
  const HeldPockets held{pockets.label(), pockets.pockets(), {0, 0}};
  const ProjectionReport report =
      projection.project(phi, boundary, kDt, DenseField<float>(grid.cells, 0), velocity, gradient, &held);
  EXPECT_LT(report.divergence, 1e-5);
}

TEST(PocketBooks, FollowAPocketThatMovesAndForgetOneThatOpens) {
  const GridSpec grid = boxGrid(24);
  const SolidBoundary boundary = buildSolidBoundary(grid, DomainWalls{}, {}, 0);
  const auto ball = [&](double x0, double radius) {
    AirPockets pockets;
    pockets.find(grid,
                 sampleCells(grid,
                             [=](const Eigen::Vector3d& x) {
                               return std::max(x.y() - 0.12,
                                               radius - (x - Eigen::Vector3d(x0, 0.06, 0.08)).norm());
                             }),
                 boundary);
    return pockets;
  };
  PocketBooks books(grid, {});
  MacVelocity velocity(grid.cells);
  const AirPockets before = ball(0.06, 0.02), after = ball(0.08, 0.0197);
  books.update(before, velocity, kDt);
  const double gas = before.pockets()[0].gas;
  EXPECT_EQ(books.gas().at(0), gas);
  velocity[0].fill(static_cast<float>(0.02 / kDt));
  books.update(after, velocity, kDt);
  EXPECT_NEAR(books.gas().at(0), gas, 1e-12 * gas);
  const double relax = -std::expm1(-kDt / FluidParams{}.volumeControlTime) / kDt;
  EXPECT_NEAR(books.growth(after, kDt)[0], relax * (gas - after.pockets()[0].gas), 1e-9 * gas / kDt);
  velocity[0].fill(0);
  books.update(ball(0.06, 0.02), velocity, kDt);  // one that comes from elsewhere is new
  EXPECT_NE(books.gas().at(0), 0);
}

/// The air under an inverted cup keeps its volume while the water around it sloshes.
TEST(ClosedPockets, HoldTheirGasWhileTheWaterSloshes) {
  const GridSpec grid = boxGrid(32);
  const double inside = 0.0613;
  const auto phi0 = [&](const Eigen::Vector3d& x) {
    const double r = std::hypot(x.x() - 0.08, x.z() - 0.08);
    const double surface = 0.12 + 0.01 * std::cos(3.14159265 * x.x() / 0.16);
    return r < 0.0355 && x.y() < 0.0955 ? x.y() - inside : x.y() - surface;
  };
  LiquidSolver solver({}, {grid, DomainWalls{}, {invertedCup(0.04, 0.09, 0.03, 0.011)}, {}}, phi0);
  ASSERT_EQ(solver.state().volume.pocketGas.size(), 1u);
  const double gas = solver.state().volume.pocketGas[0];
  double worst = 0;
  for (int n = 0; n < 30; ++n) {
    solver.step(0.01);
    AirPockets pockets;
    pockets.find(grid, solver.state().phi, solver.solids());
    double largest = 0;
    for (const AirPocket& pocket : pockets.pockets()) largest = std::max(largest, pocket.gas);
    worst = std::max(worst, std::abs(largest / gas - 1));
  }
  EXPECT_LT(worst, 0.01);
}

}  // namespace
}  // namespace spume::fluid
