#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>

#include "apps/reproduce/liquid_bench.h"
#include "apps/reproduce/liquid_studies.h"
#include "fluid/liquid_measures.h"

namespace spume::apps {
namespace {

using std::numbers::pi;

/// F1: a tank about half full at random sub-cell heights, gravity down and along the other axes.
std::vector<ResultRow> rest(const StudyContext&) {
  constexpr int kHeights = 10, kSteps = 500;
  constexpr double kStep = 0.02, kEdge = 0.16;  // [s], [m]; 10 s in all
  const fluid::GridSpec grid{{24, 24, 24}, kEdge / 24, {0, 0, 0}};
  std::mt19937 random(3);
  std::uniform_real_distribution<double> height(0.4 * kEdge, 0.6 * kEdge);
  double fastest = 0, shift = 0;
  for (int n = 0; n < kHeights; ++n) {
    const double h = height(random);
    const int up = n < kHeights / 2 ? 1 : n % 3;
    fluid::FluidParams params;
    params.gravity = -9.8 * Eigen::Vector3d::Unit(up);
    const fluid::DomainWalls walls = up == 1 ? openTop() : closedBox();
    fluid::LiquidSolver solver(params, {grid, walls, {}, {}}, [=](const auto& x) { return x[up] - h; });
    const auto surface = [&] { return surfaceAlong(solver.state(), up, {7, 9, 11}); };
    const double start = surface();
    for (int step = 0; step < kSteps; ++step) fastest = std::max(fastest, solver.step(kStep).maxSpeed);
    shift = std::max(shift, std::abs(surface() - start) / grid.dx);
  }
  ResultRow speed, level;
  speed.resolution = level.resolution = "24^3, 10 heights, gravity along 3 axes, 10 s";
  speed.quantity = "largest speed";
  level.quantity = "shift of the surface";
  speed.reference = level.reference = "zero";
  speed.source = level.source = "exact";
  return {aimAtMost(speed, fastest, 1e-8, "m/s"), aimAtMost(level, shift, 1e-6, "dx")};
}

/// Mean velocity error of the vortex sin(kx) cos(ky) that fills a free-slip box, relative to its maximum.
struct Vortex {
  double error = 0, energy = 0;  ///< energy relative to the start
};
Vortex taylorGreen(int cells, double viscosity, fluid::VelocityAdvection scheme, double duration) {
  const double k = pi;  // one vortex in the unit square
  const fluid::GridSpec grid = slab(cells, cells, 1.0 / cells);
  fluid::FluidParams params;
  params.gravity.setZero();
  params.velocityAdvection = scheme;
  params.viscosity = viscosity * params.density;
  params.noSlip = false;
  params.pressureTolerance = 1e-8;
  const Flow flow = [k](const Eigen::Vector3d& x) {
    return Eigen::Vector3d(std::sin(k * x.x()) * std::cos(k * x.y()),
                           -std::cos(k * x.x()) * std::sin(k * x.y()), 0);
  };
  fluid::LiquidSolver solver = movingLiquid(
      params, {grid, closedBox(), {}, {}}, [](const auto&) { return -1.0; }, flow);
  const int steps = cells;  // CFL 0.5 for a duration of 0.5
  for (int n = 0; n < steps; ++n) solver.step(duration / steps);
  const double decay = std::exp(-2 * viscosity * k * k * duration);
  double error = 0, energy = 0, energy0 = 0;
  for (int a = 0; a < 2; ++a)
    for (int i = 0; i < cells; ++i)
      for (int j = 0; j < cells; ++j) {
        const double u = solver.state().velocity[a](i, j, 1), u0 = flow(grid.faceCentre(a, i, j, 1))[a];
        error += std::abs(u - decay * u0) / (2.0 * cells * cells);
        energy += u * u;
        energy0 += u0 * u0;
      }
  return {error, energy / energy0};
}

std::vector<ResultRow> vortexOrder(const StudyContext&) {
  constexpr double kDuration = 0.5;
  std::vector<ResultRow> rows;
  const std::pair<fluid::VelocityAdvection, const char*> schemes[] = {
      {fluid::VelocityAdvection::trapezoidal, "trapezoidal"},
      {fluid::VelocityAdvection::macCormack, "MacCormack"},
      {fluid::VelocityAdvection::semiLagrangian, "semi-Lagrangian"}};
  for (const auto& [scheme, name] : schemes) {
    const bool second = scheme == fluid::VelocityAdvection::trapezoidal;
    const Vortex coarse = taylorGreen(32, 0, scheme, kDuration), fine = taylorGreen(64, 0, scheme, kDuration);
    const double order = std::log2(coarse.error / fine.error);
    const double k = pi, numerical = -std::log(fine.energy) / (4 * k * k * kDuration);
    ResultRow loss, rate;
    loss.resolution = rate.resolution = "32^2, 64^2";
    loss.note = rate.note = name;
    rate.quantity = "order of the velocity error";
    rate.reference = second ? "second" : "first";
    rate.source = loss.source = "exact";
    rate.figure = order;
    if (second) {
      rate.aim = ">= 1.9";
      rate.verdict = order >= 1.9 ? Verdict::met : Verdict::missed;
    }
    loss.quantity = "numerical viscosity at 64^2";
    loss.reference = "zero";
    rows.push_back(rate);
    rows.push_back(reportOnly(loss, numerical, "m^2/s, of a vortex of 1 m and 1 m/s"));
  }
  return rows;
}

std::vector<ResultRow> vortexDecay(const StudyContext&) {
  constexpr double kDuration = 2, kShort = 0.5, kThin = 1e-3;
  constexpr auto kScheme = fluid::VelocityAdvection::trapezoidal;
  std::vector<ResultRow> rows;
  for (const double nu : {kThin, 10 * kThin}) {
    const Vortex vortex = taylorGreen(64, nu, kScheme, kDuration);
    const double exact = std::exp(-4 * nu * pi * pi * kDuration);
    ResultRow r;
    r.resolution = "64^2";
    char text[48];
    std::snprintf(text, sizeof text, "energy after 2 s at nu = %.3g m^2/s", nu);
    r.quantity = text;
    r.reference = "exp(-4 nu k^2 t), difference 0";
    r.source = "exact";
    rows.push_back(aimAtMost(r, 100 * (vortex.energy / exact - 1), 2, "%"));
  }
  ResultRow order;
  order.resolution = "32^2, 64^2";
  order.quantity = "order of the velocity error at nu = 0.001 m^2/s";
  order.reference = "second";
  order.source = "exact";
  const double coarse = taylorGreen(32, kThin, kScheme, kShort).error,
               fine = taylorGreen(64, kThin, kScheme, kShort).error;
  rows.push_back(aimAtLeast(order, std::log2(coarse / fine), 1.9, ""));
  return rows;
}

/// F5: the vortex in three dimensions at Re 1600, the eighth of its period that mirrors make the whole;
/// speeds and lengths are those of the vortex.
std::vector<ResultRow> vortexBreakdown(const StudyContext&) {
  constexpr int kCells = 32, kSteps = 200;
  constexpr double kEnd = 10, kReynolds = 1600;
  const fluid::GridSpec grid{Eigen::Vector3i::Constant(kCells), pi / kCells, Eigen::Vector3d::Zero()};
  fluid::FluidParams params;
  params.gravity.setZero();
  params.viscosity = params.density / kReynolds;
  params.noSlip = false;
  const Flow flow = [](const Eigen::Vector3d& x) {
    return Eigen::Vector3d(std::sin(x.x()) * std::cos(x.y()) * std::cos(x.z()),
                           -std::cos(x.x()) * std::sin(x.y()) * std::cos(x.z()), 0);
  };
  fluid::LiquidSolver solver = movingLiquid(
      params, {grid, closedBox(), {}, {}}, [](const auto&) { return -1.0; }, flow);
  const double mass = params.density * pi * pi * pi;
  double energy = 0.125, rise = 0, peak = 0, peakTime = 0;
  for (int n = 0; n < kSteps; ++n) {
    const double now = solver.step(kEnd / kSteps).kineticEnergy / mass, rate = (energy - now) * kSteps / kEnd;
    rise = std::max(rise, now / energy - 1);
    if (rate > peak) peak = rate, peakTime = solver.state().time;
    energy = now;
  }
  ResultRow monotone, dissipation, moment;
  monotone.resolution = dissipation.resolution = moment.resolution = "64^3 with its mirror images, Re 1600";
  monotone.quantity = "largest rise of the energy in a step";
  monotone.reference = "none";
  monotone.source = "exact";
  dissipation.quantity = "peak of the dissipation";
  dissipation.reference = "DNS 0.0127 to 0.013";
  moment.quantity = "time of the peak";
  moment.reference = "DNS 9";
  dissipation.source = moment.source = "from memory";
  return {aimAtMost(monotone, 100 * rise, 1e-3, "%"), reportOnly(dissipation, peak, "U^3/L"),
          reportOnly(moment, peakTime, "L/U")};
}

/// Largest distance [dx] of the surface from the sphere it should be, at the cells next to it.
double strayOfSphere(const fluid::LiquidState& state, const Eigen::Vector3d& centre, double radius) {
  const fluid::GridSpec& grid = state.grid;
  double stray = 0;
  for (int i = 0; i < grid.cells.x(); ++i)
    for (int j = 0; j < grid.cells.y(); ++j)
      for (int k = 0; k < grid.cells.z(); ++k) {
        const double exact = (grid.cellCentre(i, j, k) - centre).norm() - radius;
        if (std::abs(exact) < grid.dx) stray = std::max(stray, std::abs(state.phi(i, j, k) - exact));
      }
  return stray / grid.dx;
}

/// F14: a ball of water that falls for 0.1 s without touching anything.
std::vector<ResultRow> freeFall(const StudyContext&) {
  const fluid::GridSpec grid{{48, 64, 48}, 0.16 / 64, {0, 0, 0}};
  constexpr double kRadius = 0.02;
  const Eigen::Vector3d centre(0.061, 0.115, 0.058);
  fluid::LiquidSolver solver({}, {grid, closedBox(), {}, {}},
                             [&](const Eigen::Vector3d& x) { return (x - centre).norm() - kRadius; });
  const double volume0 = solver.liquidVolume(), potential0 = solver.step(0).potentialEnergy;
  fluid::LiquidStepReport last;
  constexpr int kSteps = 20;
  for (int n = 0; n < kSteps; ++n) last = solver.step(0.1 / kSteps);
  const double g = 9.8,
               fallen = (potential0 - last.potentialEnergy) / (solver.params().density * g * volume0);
  ResultRow place, volume, shape;
  place.resolution = volume.resolution = shape.resolution = "radius 8 dx";
  place.quantity = "error of the centroid";
  volume.quantity = "change of the volume";
  shape.quantity = "largest distance of the surface from the fallen ball's";
  place.reference = volume.reference = shape.reference = "zero";
  place.source = volume.source = shape.source = "exact";
  const Eigen::Vector3d below = centre - 0.5 * g * 0.01 * Eigen::Vector3d::UnitY();
  return {aimAtMost(place, (fallen - 0.5 * g * 0.01) / grid.dx, 0.1, "dx"),
          aimAtMost(shape, strayOfSphere(solver.state(), below, kRadius), 0.1, "dx"),
          aimAtMost(volume, 100 * (solver.liquidVolume() / volume0 - 1), 0.5, "%")};
}

}  // namespace

std::vector<Study> exactFlowStudies() {
  return {{"F1", "hydrostatic rest", 120, rest},
          {"F4", "Taylor-Green vortex, inviscid", 30, vortexOrder},
          {"F4b", "Taylor-Green vortex, viscous", 15, vortexDecay},
          {"F5", "Taylor-Green vortex in 3D", 40, vortexBreakdown},
          {"F14", "free-falling ball of water", 15, freeFall}};
}

}  // namespace spume::apps
