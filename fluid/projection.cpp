#include "fluid/projection.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "fluid/curvature.h"
#include "fluid/errors.h"
#include "fluid/parallel.h"
#include "fluid/projection_system.h"

namespace spume::fluid {
namespace {

// Right-hand sides below this are rest [m/s]: what it could still move is far below the 1e-8 m/s asked of a
// still tank, and above the round-off of double sums of velocities up to 1000 m/s times their face fractions.
constexpr double kRest = 1e-12;

std::string failure(const SolveReport& solve, double tolerance, double dt) {
  char text[160];
  std::snprintf(text, sizeof text,
                "pressure: %d iterations left a residual of %.3g m/s, wanted %.3g m/s, at dt %.3g s",
                solve.iterations, solve.residual, tolerance, dt);
  return text;
}

}  // namespace

/// u + dt g - (dt/rho) grad p on an open face between an unknown and air; `c` is the cell on its upper side.
double ProjectionSystem::projectedFace(const Eigen::Vector3i& c, int axis, double u) const {
  const Eigen::Vector3i lower = c - Eigen::Vector3i::Unit(axis);
  const bool upperWet = component(c) >= 0;
  const Eigen::Vector3i& wet = upperWet ? c : lower;
  const Component& body = components[component(wet)];
  const double falling = body.hydrostatic ? u : u + dt * params.gravity[axis];
  const int side = upperWet ? -1 : 1;
  const Surface known = surfaceBeside(wet, axis, side);
  const double rise = surfaceValue(body, wet, axis, side, known.theta) - solution(wet);
  return falling - side * known.coefficient / openTowards(wet, axis, side) * rise;
}

/// One face of updateVelocity with a wet cell on one side alone, or closed.
void ProjectionSystem::updateFace(const Eigen::Vector3i& c, int axis, float& velocity, float& gradient) {
  const bool open = boundary->open[axis](c) > 0, given = boundary->prescribed[axis](c) != 0;
  const bool wall = !open && !given && (c[axis] == 0 || c[axis] == grid.cells[axis]);
  valid[axis](c) = given || open || wall;
  if (wall) velocity = boundary->velocity[axis](c);
  if (!open) return;
  const double projected = projectedFace(c, axis, velocity);
  gradient = static_cast<float>(params.density * (params.gravity[axis] - (projected - velocity) / dt));
  velocity = static_cast<float>(projected);
}

/// A run of faces in one body, given the pressures above and below them. On its own so that nothing it reads
/// can alias what it writes.
[[gnu::noinline]] void ProjectionSystem::updateRun(int axis, bool hydrostatic, const double* __restrict above,
                                                   const double* __restrict below, int count,
                                                   float* __restrict velocity,
                                                   float* __restrict gradient) const {
  const double fall = dt * params.gravity[axis], toGradient = params.density / dt;
  const double pull = hydrostatic ? fall : 0;
  for (int k = 0; k < count; ++k) {
    const double push = above[k] - below[k];
    velocity[k] = static_cast<float>(velocity[k] + (fall - pull - push));
    gradient[k] = static_cast<float>(toGradient * (pull + push));
  }
}

void ProjectionSystem::updateVelocity(int axis, DenseField<float>& velocity, DenseField<float>& gradient) {
  const auto step = component.stride(axis), stepBack = solution.stride(axis);
  const Eigen::Vector3i& size = velocity.size();
  forEachRow(size, [&](int i, int j) {
    const std::int32_t* wet = &component(i, j, 0);
    const std::uint8_t* given = &boundary->prescribed[axis](i, j, 0);
    const float* open = &boundary->open[axis](i, j, 0);
    const double* q = &solution(i, j, 0);
    float *u = &velocity(i, j, 0), *g = &gradient(i, j, 0);
    std::uint8_t* set = &valid[axis](i, j, 0);
    const auto isDry = [&](int k) { return (wet[k] & wet[k - step]) < 0; };  // on both sides
    const auto isInside = [&](int k, std::int32_t body) {
      return wet[k] == body && wet[k - step] >= 0 && open[k] > 0;
    };
    std::fill_n(g, size.z(), 0.0f);
    for (int k = 0, end = 0; k < size.z(); k = end) {
      while (end < size.z() && isDry(end)) ++end;
      std::copy(given + k, given + end, set + k);
      if (end > k) continue;
      const std::int32_t body = wet[k];
      while (body >= 0 && end < size.z() && isInside(end, body)) ++end;
      if (end > k) {
        updateRun(axis, components[body].hydrostatic, q + k, q + k - stepBack, end - k, u + k, g + k);
        std::fill(set + k, set + end, std::uint8_t{1});
      } else {
        updateFace({i, j, k}, axis, u[k], g[k]);
        end = k + 1;
      }
    }
  });
}

void ProjectionSystem::writePressure() {
  const double toPressure = params.density * grid.dx / dt;
  forEachCell(grid.cells, [&](int i, int j, int k) {
    const Eigen::Vector3i c(i, j, k);
    const std::int32_t n = component(c);
    double p = 0;
    if (n >= 0) p = toPressure * solution(c);
    if (n >= 0 && components[n].hydrostatic) p += params.density * (gravityAt(c) - components[n].level);
    if (n < 0 && held && held->label(c) >= 0) p = toPressure * pocketPressure[held->label(c)];
    pressure(c) = static_cast<float>(p);
  });
}

double ProjectionSystem::largestDivergence(const MacVelocity& velocity, const DenseField<float>& source) {
  return reduceActiveRows(
      multigrid.finest().rows,
      [&](const ActiveRow& row) {
        const std::int32_t* wet = &component(row.i, row.j, 0);
        double* outflow = &plainRhs(row.i, row.j, 0);
        outflowOfRow(*boundary, velocity, row, outflow);
        for (int k = row.begin; k < row.end; ++k)
          outflow[k] = wet[k] >= 0 ? outflow[k] - source(row.i, row.j, k) * grid.dx : 0;
        return maxMagnitude(outflow + row.begin, row.end - row.begin);
      },
      [](double a, double b) { return std::max(a, b); });
}

Projection::Projection(const GridSpec& grid, const FluidParams& params)
    : internals_(std::make_unique<ProjectionSystem>(grid, params)) {}
Projection::~Projection() = default;
Projection::Projection(Projection&&) noexcept = default;

ProjectionReport Projection::project(const DenseField<float>& phi, const SolidBoundary& boundary, double dt,
                                     const DenseField<float>& divergenceSource, MacVelocity& velocity,
                                     MacField<float>& pressureGradient, const HeldPockets* pockets) {
  ProjectionSystem& in = *internals_;
  in.phi = &phi;
  in.boundary = &boundary;
  in.held = pockets;
  in.dt = dt;
  if (in.params.surfaceTension > 0) computeCurvature(in.grid, boundary.sides, phi, in.kappa);
  in.findComponents();
  in.assembleMatrix();
  in.findPocketSurfaces();
  in.findLevels();
  in.levelPockets();
  in.assembleRightHandSide(velocity, divergenceSource);
  in.chooseGravity();
  in.relevelPockets();
  in.assemblePockets(velocity);

  ProjectionReport report;
  report.incompatible = in.centreAirless(in.rhs);
  const double scale = in.scaleOfRightHandSide();
  const double tolerance = std::max(kRest, in.params.pressureTolerance * scale);
  const SolveReport solve =
      in.solver.solve(in.multigrid, in.rhs, in.solution, tolerance, in.params.pressureIterations, in.pockets);
  if (!solve.converged) throw NumericalFailure(failure(solve, tolerance, dt));
  in.centreAirless(in.solution);
  for (std::size_t n = 0; n < in.pocketPressure.size(); ++n) in.pocketPressure[n] += in.pockets.solution[n];

  for (int a = 0; a < 3; ++a) in.updateVelocity(a, velocity[a], pressureGradient[a]);
  in.writePressure();
  report.iterations = solve.iterations;
  report.residual = scale > kRest ? solve.residual / scale : 0;
  report.divergence = in.largestDivergence(velocity, divergenceSource);
  return report;
}

const MacField<std::uint8_t>& Projection::valid() const { return internals_->valid; }
const DenseField<float>& Projection::pressure() const { return internals_->pressure; }

}  // namespace spume::fluid
