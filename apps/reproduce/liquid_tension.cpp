#include <algorithm>
#include <cmath>
#include <numbers>

#include "apps/reproduce/liquid_bench.h"
#include "apps/reproduce/liquid_studies.h"
#include "fluid/level_set.h"

namespace spume::apps {
namespace {

using std::numbers::pi;

constexpr double kSigma = 0.0728;  // water in air [N/m]

fluid::FluidParams waterWithoutGravity() {
  fluid::FluidParams params;
  params.gravity.setZero();
  params.density = 998.2;
  params.surfaceTension = kSigma;
  return params;
}

/// Second moment of the liquid along y less that along x, over that of a ball: its quadrupole.
double elongation(const fluid::LiquidSolver& solver) {
  const fluid::LiquidState& state = solver.state();
  const fluid::GridSpec& grid = state.grid;
  Eigen::Vector3d first = Eigen::Vector3d::Zero(), second = first;
  double volume = 0;
  for (int i = 0; i < grid.cells.x(); ++i)
    for (int j = 0; j < grid.cells.y(); ++j)
      for (int k = 0; k < grid.cells.z(); ++k) {
        const double part = fluid::liquidFractionOfCell(state.phi, static_cast<float>(grid.dx), i, j, k);
        const Eigen::Vector3d x = grid.cellCentre(i, j, k);
        volume += part;
        first += part * x;
        second += part * x.cwiseAbs2();
      }
  first /= volume;
  const Eigen::Vector3d spread = second / volume - first.cwiseAbs2();
  return (spread.y() - 0.5 * (spread.x() + spread.z())) / spread.sum();
}

/// F15: a drop let go with a slight second mode, without gravity.
std::vector<ResultRow> oscillation(const StudyContext&) {
  constexpr double kRadius = 0.02, kAmplitude = 0.02;
  constexpr int kCells = 48, kRadiusCells = 16;
  const double dx = kRadius / kRadiusCells, middle = 0.5 * kCells * dx + 0.3 * dx;
  const fluid::FluidParams params = waterWithoutGravity();
  const auto phi0 = [=](const Eigen::Vector3d& x) {
    const Eigen::Vector3d r = x - Eigen::Vector3d::Constant(middle);
    const double c = r.y() / std::max(r.norm(), 1e-12);
    return r.norm() - kRadius * (1 + kAmplitude * 0.5 * (3 * c * c - 1));
  };
  fluid::LiquidSolver solver(params, {{{kCells, kCells, kCells}, dx, {0, 0, 0}}, closedBox(), {}, {}}, phi0);
  const double exact = 2 * pi / std::sqrt(8 * kSigma / (params.density * std::pow(kRadius, 3)));
  const double dt = exact / 400;
  std::vector<double> zeros;
  double before = elongation(solver);
  while (zeros.size() < 3 && solver.state().time < 1.6 * exact) {
    solver.step(dt);
    const double now = elongation(solver);
    if (before * now < 0) zeros.push_back(solver.state().time - dt * now / (now - before));
    before = now;
  }
  const double period = zeros.size() < 3 ? 0 : zeros[2] - zeros[0];
  ResultRow r;
  r.resolution = "radius 16 dx";
  r.quantity = "error of the period";
  r.reference = "T = 0.73640 s";
  r.source = "Rayleigh, Lamb";
  return {aimAtMost(r, 100 * (period / exact - 1), 2, "%")};
}

/// F16: a drop at rest, Laplace number 12000, for one viscous time.
std::vector<ResultRow> staticDrop(const StudyContext&) {
  constexpr double kRadius = 0.02, kLaplace = 12000;
  constexpr int kCells = 40, kRadiusCells = 12, kSteps = 150;
  const double dx = kRadius / kRadiusCells, middle = 0.5 * kCells * dx + 0.2 * dx;
  fluid::FluidParams params = waterWithoutGravity();
  params.viscosity = std::sqrt(kSigma * params.density * 2 * kRadius / kLaplace);
  const auto phi0 = [=](const Eigen::Vector3d& x) {
    return (x - Eigen::Vector3d::Constant(middle)).norm() - kRadius;
  };
  fluid::LiquidSolver solver(params, {{{kCells, kCells, kCells}, dx, {0, 0, 0}}, closedBox(), {}, {}}, phi0);
  const double slowest = params.density * kRadius * kRadius / params.viscosity;
  fluid::LiquidStepReport report;
  for (int n = 0; n < kSteps; ++n) report = solver.step(0.25 * slowest / kSteps);
  ResultRow r;
  r.resolution = "radius 12 dx, La 12000";
  r.quantity = "capillary number of the currents";
  r.reference = "0; balanced VOF machine zero (Popinet 2009)";
  r.source = "exact";
  r.note = "after a quarter of the viscous time";
  return {aimAtMost(r, params.viscosity * report.maxSpeed / kSigma, 1e-4, "")};
}

}  // namespace

std::vector<Study> tensionStudies() {
  return {{"F15", "oscillating drop", 200, oscillation}, {"F16", "static drop", 120, staticDrop}};
}

}  // namespace spume::apps
