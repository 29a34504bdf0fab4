#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "fluid/errors.h"
#include "fluid/inflow.h"
#include "fluid/level_set.h"
#include "fluid/liquid_solver.h"
#include "fluid/projection.h"
#include "tests/fluid_scenery.h"
#include "tests/support/fluid_fields.h"

namespace spume::fluid {
namespace {

using namespace testing;

constexpr double kDt = 0.004;
// The flux is carried by some 80 faces of float velocity.
constexpr double kFluxError = 1e-6;

/// A nozzle: a disc of `radius` about `centre` that pours along `velocity`, the region reaching `depth`
/// upstream.
Inflow nozzle(const Eigen::Vector3d& centre, const Eigen::Vector3d& velocity, double radius, double depth) {
  const Eigen::Vector3d axis = velocity.normalized();
  Inflow inflow;
  inflow.name = "nozzle";
  inflow.sdf = [=](const Eigen::Vector3d& x) {
    const double along = -(x - centre).dot(axis), across = ((x - centre) + along * axis).norm();
    return std::max({across - radius, -along, along - depth});
  };
  inflow.velocity = velocity;
  inflow.area = std::numbers::pi * radius * radius;
  return inflow;
}

TEST(Inflow, ExitFacesCarryTheExactFluxAtAnySubCellPlace) {
  const GridSpec grid = boxGrid(32);
  for (int n = 0; n < 12; ++n) {
    const double shift = grid.dx * n / 12;
    Inflow inflow = nozzle({0.07 + shift, 0.16 - 3 * grid.dx - 0.3 * shift, 0.09 - 0.7 * shift}, {0, -0.8, 0},
                           0.01, 4 * grid.dx);
    inflow.turbulence = n % 3 == 0 ? 0.2 : 0;
    inflow.scale = [](double t) { return 1 - t; };
    InflowSet inflows(grid, {inflow}, 1);
    SolidBoundary boundary = buildSolidBoundary(grid, DomainWalls{}, {}, 0);
    DenseField<float> phi(grid.cells, 1);
    inflows.stamp(0.5, kDt, phi, boundary);
    const double exact = 0.5 * 0.8 * inflow.area;
    EXPECT_NEAR(inflows.flux(0, 0.5), exact, 1e-15);
    double flux = 0;  // through one row of faces inside the nozzle
    forEachFace(grid, [&](int a, const Eigen::Vector3i& c) {
      EXPECT_EQ(boundary.prescribed[a](c) != 0 && c[a] > 0 && c[a] < 32,
                boundary.open[a](c) == 0 && c[a] > 0 && c[a] < 32);
      if (a == 1 && c.y() == 30) flux -= boundary.velocity[1](c) * grid.dx * grid.dx;
      if (a != 1 && boundary.prescribed[a](c)) {
        EXPECT_EQ(boundary.velocity[a](c), 0);
      }
    });
    EXPECT_NEAR(flux / exact, 1, kFluxError) << n;
  }
}

/// What enters a pool under water must leave through its surface, whatever the direction of the jet.
TEST(Inflow, ASubmergedJetRaisesThePoolByItsFlux) {
  const GridSpec grid = boxGrid(32);
  const auto still = sampleCells(grid, [](const Eigen::Vector3d& x) { return x.y() - 0.1312; });
  for (const Eigen::Vector3d& velocity : {Eigen::Vector3d(0.5, 0, 0), Eigen::Vector3d(0.3, -0.4, 0.2)}) {
    const Inflow inflow = nozzle({0.08, 0.07, 0.08}, velocity, 0.012, 4 * grid.dx);
    InflowSet inflows(grid, {inflow}, 1);
    SolidBoundary boundary = buildSolidBoundary(grid, DomainWalls{}, {}, 0);
    DenseField<float> phi = still, source(grid.cells, 0);
    const auto& poured = inflows.stamp(1, kDt, phi, boundary);
    const double exact = velocity.norm() * inflow.area;
    ASSERT_EQ(poured.size(), 1u);
    EXPECT_NEAR(poured[0].volume / (exact * kDt), 1, 1e-9);
    MacVelocity flow(grid.cells);
    inflows.setVelocity(flow);
    inflows.addSource(source);
    FluidParams params;
    params.pressureTolerance = 1e-9;
    Projection projection(grid, params);
    MacField<float> gradient(grid.cells);
    projection.project(phi, boundary, kDt, source, flow, gradient);
    double raised = 0;
    const int row = static_cast<int>(0.125 / grid.dx);
    for (int i = 0; i < 32; ++i)
      for (int k = 0; k < 32; ++k) raised += flow[1](i, row, k) * grid.dx * grid.dx;
    EXPECT_NEAR(raised / exact, 1, 1e-5);  // 1024 float velocities
  }
}

TEST(Inflow, OpeningBooksTheLiquidThatFillsTheNozzleOnce) {
  const GridSpec grid = boxGrid(32);
  Inflow inflow = nozzle({0.08, 0.16 - 3 * grid.dx, 0.08}, {0, -0.8, 0}, 0.01, 4 * grid.dx);
  inflow.scale = [](double t) { return t > 0.01 && t < 0.5 ? 1 : 0; };
  InflowSet inflows(grid, {inflow}, 1);
  SolidBoundary boundary = buildSolidBoundary(grid, DomainWalls{}, {}, 0);
  DenseField<float> phi(grid.cells, 1);
  EXPECT_TRUE(inflows.stamp(0.008, kDt, phi, boundary).empty());
  EXPECT_EQ(liquidVolume(grid, phi, boundary), 0);
  const double first = inflows.stamp(0.012, kDt, phi, boundary).at(0).volume;
  EXPECT_NEAR(first, inflows.flux(0, 0.012) * kDt + liquidVolume(grid, phi, boundary), 1e-12);
  EXPECT_NEAR(inflows.stamp(0.016, kDt, phi, boundary).at(0).volume, inflows.flux(0, 0.016) * kDt, 1e-15);
}

TEST(Inflow, AClosedNozzleGivesItsFacesBack) {
  const GridSpec grid = boxGrid(24);
  Inflow inflow = nozzle({0.08, 0.14, 0.08}, {0, -0.8, 0}, 0.02, 4 * grid.dx);
  inflow.scale = [](double t) { return t < 1 ? 1 : 0; };
  InflowSet inflows(grid, {inflow}, 1);
  const SolidBoundary before =
      buildSolidBoundary(grid, DomainWalls{}, {sphere({0.09, 0.145, 0.08}, 0.01)}, 0);
  SolidBoundary boundary = before;
  DenseField<float> phi(grid.cells, 1);
  for (double t : {0.5, 0.6, 1.5}) inflows.stamp(t, kDt, phi, boundary);
  forEachFace(grid, [&](int a, const Eigen::Vector3i& c) {
    EXPECT_EQ(boundary.open[a](c), before.open[a](c));
    EXPECT_EQ(boundary.velocity[a](c), before.velocity[a](c));
    EXPECT_EQ(boundary.prescribed[a](c), 0);
  });
}

/// The first step of a dry glass fails, as one of a moving solid too fast does, and is tried again with half
/// its length: before it nothing was poured, not even what fills the nozzle.
TEST(Inflow, AFirstStepTakenBackLeavesADryGlassDry) {
  const GridSpec grid = boxGrid(16);
  const LiquidSetup setup = {
      grid, DomainWalls{}, {}, {nozzle({0.08, 0.12, 0.08}, {0, -0.8, 0}, 0.025, 0.03)}};
  const auto dry = [](const Eigen::Vector3d&) { return 1.0; };
  LiquidSolver solver({}, setup, dry), fresh({}, setup, dry);
  solver.step(kDt), solver.rollBack();
  EXPECT_EQ(solver.liquidVolume(), 0);
  solver.step(kDt), fresh.step(kDt);
  EXPECT_TRUE(test::sameBits(solver.state().phi, fresh.state().phi));
  for (int a = 0; a < 3; ++a)
    EXPECT_TRUE(test::sameBits(solver.state().velocity[a], fresh.state().velocity[a]));
}

/// Sub-steps add up to a step but for round-off; the last one has to know what opens at the step's end, as a
/// run resumed from there does.
TEST(Inflow, OneThatOpensAtTheEndOfAStepIsOpenInARunResumedThere) {
  const GridSpec grid = boxGrid(16);
  FluidParams params;
  params.cfl = 0.3;
  const auto ball = [](const Eigen::Vector3d& x) {
    return (x - Eigen::Vector3d(0.08, 0.1, 0.04)).norm() - 0.03;
  };
  int subSteps = 0;
  for (double dt = 0.03; dt < 0.04; dt += 1e-3) {
    LiquidSetup setup = {grid, DomainWalls{}, {}, {nozzle({0.08, 0.12, 0.12}, {0, -0.8, 0}, 0.025, 0.03)}};
    const double opens = dt + dt;
    setup.inflows[0].scale = [opens](double t) { return t >= opens ? 1 : 0; };
    LiquidSolver solver(params, setup, ball);
    solver.step(dt), subSteps = std::max(subSteps, solver.step(dt).subSteps);
    ASSERT_EQ(solver.state().time, opens);
    LiquidSolver resumed(params, setup, solver.state());
    solver.step(kDt), resumed.step(kDt);
    EXPECT_TRUE(test::sameBits(solver.state().phi, resumed.state().phi)) << dt;
  }
  EXPECT_GE(subSteps, 3);
}

/// Where a nozzle reaches into a solid, phi there is what liquid outside makes of it, not the nozzle's: a
/// checkpoint holds it as it is.
TEST(Inflow, ARunResumedOrTakenBackGoesOnAsItWas) {
  const GridSpec grid = boxGrid(16);
  const LiquidSetup setup = {grid,
                             DomainWalls{},
                             {sphere({0.08, 0.09, 0.05}, 0.03)},
                             {nozzle({0.08, 0.1, 0.08}, {0, -0.3, 0}, 0.02, 0.03)}};
  LiquidSolver solver({}, setup, [](const Eigen::Vector3d& x) { return x.y() - 0.05; });
  for (int step = 0; step < 6; ++step) {
    solver.step(3 * kDt);
    LiquidSolver resumed({}, setup, solver.state());
    EXPECT_TRUE(test::sameBits(solver.state().phi, resumed.state().phi)) << step;
    solver.step(kDt), solver.rollBack();
    solver.step(kDt), resumed.step(kDt);
    for (int a = 0; a < 3; ++a)
      EXPECT_TRUE(test::sameBits(solver.state().velocity[a], resumed.state().velocity[a])) << step;
  }
}

TEST(Inflow, RejectsWhatCannotPour) {
  const GridSpec grid = boxGrid(16);
  const Inflow good = nozzle({0.08, 0.14, 0.08}, {0, -0.8, 0}, 0.02, 0.04);
  Inflow still = good, outside = good, wild = good;
  still.velocity.setZero();
  outside.sdf = [](const Eigen::Vector3d& x) { return (x - Eigen::Vector3d(1, 1, 1)).norm() - 0.1; };
  wild.turbulence = 0.7;
  for (const Inflow& bad : {still, outside, wild}) EXPECT_THROW(InflowSet(grid, {bad}, 1), InvalidParameter);
}

}  // namespace
}  // namespace spume::fluid
