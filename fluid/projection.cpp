#include "fluid/projection.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "fluid/conjugate_gradient.h"
#include "fluid/connected_cells.h"
#include "fluid/errors.h"
#include "fluid/multigrid.h"
#include "fluid/parallel.h"
#include "fluid/pressure_rows.h"

namespace spume::fluid {
namespace {

// Least distance of the surface from a liquid cell's centre [dx]: bounds the matrix's condition (model,
// Section 3).
constexpr double kLeastTheta = 0.01;
// Distance of an open domain boundary from the centres beside it [dx].
constexpr double kBoundaryTheta = 0.5;
// Right-hand sides below this are rest [m/s]: what it could still move is far below the 1e-8 m/s asked of a
// still tank, and above the round-off of double sums of velocities up to 1000 m/s times their face fractions.
constexpr double kRest = 1e-12;
// The residual is compared with the right-hand side scaled to this diagonal: six full neighbours. Without it
// a single cell grazed by the surface (1/theta = 100) would loosen the tolerance of all others.
constexpr double kFullDiagonal = 6;

/// A set of unknowns joined by the matrix.
struct Component {
  double level = 0;             // mean of g.x over its surface, or over its cells if it has none [m^2/s^2]
  std::ptrdiff_t surfaces = 0;  // faces with air behind
  std::ptrdiff_t cells = 0;
  double lifted = 0, plain = 0;  // squared right-hand sides without and with gravity
  double sum = 0;                // of the right-hand side, then of the solution
  bool hydrostatic = true;       // solved without gravity, less the hydrostatic pressure
  double mean() const { return sum / static_cast<double>(cells); }
};

/// Where the pressure is known next to a liquid cell.
struct Surface {
  float coefficient;  // open / theta of its face
  double theta;       // true distance from the cell's centre [dx]
};

std::string failure(const SolveReport& solve, double tolerance, double dt) {
  char text[160];
  std::snprintf(text, sizeof text,
                "pressure: %d iterations left a residual of %.3g m/s, wanted %.3g m/s, at dt %.3g s",
                solve.iterations, solve.residual, tolerance, dt);
  return text;
}

}  // namespace

/// Unknown: q = p dt/(rho dx) [m/s]. In a component with a surface at rest, or nearly so, q is solved for
/// less its hydrostatic part (dt/dx)(g.x - level), which cancels gravity on every face without any
/// subtraction; one that falls freely is solved for as it is. Both give the same discrete solution; each is
/// exact for its own rest.
struct Projection::Internals {
  GridSpec grid;
  FluidParams params;
  Multigrid multigrid;
  ConjugateGradient solver;
  ConnectedCells connected;
  DenseField<std::int32_t> component;
  std::vector<Component> components;
  DenseField<double> rhs, plainRhs, solution;
  MacField<std::uint8_t> valid;
  DenseField<float> pressure;

  const DenseField<float>* phi = nullptr;  // of the call under way
  const SolidBoundary* boundary = nullptr;
  double dt = 0;

  Internals(const GridSpec& g, const FluidParams& p)
      : grid(g),
        params(p),
        multigrid(g.cells),
        solver(g.cells),
        component(g.cells, -1),
        rhs(g.cells),
        plainRhs(g.cells),
        solution(g.cells),
        valid(g.cells),
        pressure(g.cells) {}

  /// g.x at a cell centre [m^2/s^2].
  double gravityAt(const Eigen::Vector3i& c) const {
    return params.gravity.dot(grid.cellCentre(c.x(), c.y(), c.z()));
  }
  bool isSurface(const Eigen::Vector3i& c, int axis, int side) const {
    return openTowards(c, axis, side) > 0 && component(c + side * Eigen::Vector3i::Unit(axis)) < 0;
  }
  float openTowards(const Eigen::Vector3i& c, int axis, int side) const {
    return boundary->open[axis](side > 0 ? c + Eigen::Vector3i::Unit(axis) : c);
  }
  /// Reduced q at the surface [m/s].
  double surfaceValue(const Component& body, const Eigen::Vector3i& c, int axis, int side,
                      double theta) const {
    if (!body.hydrostatic) return 0;
    const double there = gravityAt(c) + side * theta * grid.dx * params.gravity[axis];
    return -dt / grid.dx * (there - body.level);
  }

  Surface surfaceBeside(const Eigen::Vector3i& c, int axis, int side) const;
  void findComponents();
  void assembleMatrix();
  void findLevels();
  void assembleCell(const Eigen::Vector3i& c, const MacVelocity& velocity, float source);
  void assembleRightHandSide(const MacVelocity& velocity, const DenseField<float>& source);
  void chooseGravity();
  double centreAirless(DenseField<double>& field);
  double scaleOfRightHandSide() const;
  double projectedFace(const Eigen::Vector3i& c, int axis, double u) const;
  void updateVelocity(int axis, DenseField<float>& velocity, DenseField<float>& gradient);
  void writePressure();
  double largestDivergence(const MacVelocity& velocity, const DenseField<float>& source) const;
};

Surface Projection::Internals::surfaceBeside(const Eigen::Vector3i& c, int axis, int side) const {
  const Eigen::Vector3i step = side * Eigen::Vector3i::Unit(axis), n = c + step, behind = c - step;
  const auto inside = [&](const Eigen::Vector3i& x) { return phi->contains(x.x(), x.y(), x.z()); };
  const double here = (*phi)(c);
  double theta = kBoundaryTheta;
  if (inside(n)) {
    theta = here / (here - (*phi)(n));
  } else if (inside(behind)) {
    const double rise = here - (*phi)(behind);
    if (rise > 0) theta = std::min(kBoundaryTheta, -here / rise);
  }
  const double open = openTowards(c, axis, side);
  return {static_cast<float>(open / std::max(theta, kLeastTheta)), theta};
}

void Projection::Internals::findComponents() {
  const SolidBoundary& solid = *boundary;
  const int count = connected.label(
      grid.cells, [&](int i, int j, int k) { return (*phi)(i, j, k) < 0 && solid.hasOpenFace(i, j, k); },
      [&](int axis, int i, int j, int k) { return solid.open[axis](i, j, k) > 0; }, component);
  components.assign(count, Component{});
}

void Projection::Internals::assembleMatrix() {
  PressureMatrix& matrix = multigrid.finest();
  forEachCell(grid.cells, [&](int i, int j, int k) {
    const Eigen::Vector3i c(i, j, k);
    float excess = 0;
    for (int a = 0; a < 3; ++a) {
      const bool joined = component(c) >= 0 && component(c - Eigen::Vector3i::Unit(a)) >= 0;
      matrix.weight[a](c) = joined ? boundary->open[a](c) : 0;
      if (component(c) < 0) continue;
      for (int side : {-1, 1})
        if (isSurface(c, a, side)) excess += surfaceBeside(c, a, side).coefficient;
    }
    matrix.excess(c) = excess;
  });
  matrix.finish();
  multigrid.coarsen();
}

void Projection::Internals::findLevels() {
  const DenseField<float>& excess = multigrid.finest().excess;
  std::vector<double> cellSum(components.size(), 0);
  for (const ActiveRow& row : multigrid.finest().rows)
    for (int k = row.begin; k < row.end; ++k) {
      const Eigen::Vector3i c(row.i, row.j, k);
      if (component(c) < 0) continue;
      Component& body = components[component(c)];
      ++body.cells;
      cellSum[component(c)] += gravityAt(c);
      if (!(excess(c) > 0)) continue;
      for (int a = 0; a < 3; ++a)
        for (int side : {-1, 1}) {
          if (!isSurface(c, a, side)) continue;
          ++body.surfaces;
          body.level += gravityAt(c) + side * surfaceBeside(c, a, side).theta * grid.dx * params.gravity[a];
        }
    }
  for (std::size_t n = 0; n < components.size(); ++n) {
    Component& body = components[n];
    body.level =
        body.surfaces > 0 ? body.level / static_cast<double>(body.surfaces) : cellSum[n] / body.cells;
  }
}

void Projection::Internals::assembleCell(const Eigen::Vector3i& c, const MacVelocity& velocity,
                                         float source) {
  const Component& body = components[component(c)];
  const bool atSurface = multigrid.finest().excess(c) > 0;
  double flowIn = source * grid.dx, gravityIn = 0, surface = 0;
  for (int a = 0; a < 3; ++a)
    for (int side : {-1, 1}) {
      const Eigen::Vector3i face = side > 0 ? c + Eigen::Vector3i::Unit(a) : c;
      const double open = boundary->open[a](face);
      flowIn -= side * (open * velocity[a](face) + (1 - open) * boundary->velocity[a](face));
      gravityIn -= side * open * dt * params.gravity[a];
      if (!atSurface || !isSurface(c, a, side)) continue;
      const Surface known = surfaceBeside(c, a, side);
      surface += known.coefficient * surfaceValue(body, c, a, side, known.theta);
    }
  rhs(c) = flowIn + surface;
  plainRhs(c) = flowIn + gravityIn;
}

void Projection::Internals::assembleRightHandSide(const MacVelocity& velocity,
                                                  const DenseField<float>& source) {
  forEachCell(grid.cells, [&](int i, int j, int k) {
    const Eigen::Vector3i c(i, j, k);
    if (component(c) >= 0)
      assembleCell(c, velocity, source(c));
    else
      rhs(c) = plainRhs(c) = 0;
  });
}

/// Decides for each component which form has the smaller right-hand side.
void Projection::Internals::chooseGravity() {
  const auto& rows = multigrid.finest().rows;
  for (const ActiveRow& row : rows)
    for (int k = row.begin; k < row.end; ++k) {
      const std::int32_t n = component(row.i, row.j, k);
      if (n < 0) continue;
      components[n].lifted += rhs(row.i, row.j, k) * rhs(row.i, row.j, k);
      components[n].plain += plainRhs(row.i, row.j, k) * plainRhs(row.i, row.j, k);
    }
  for (Component& body : components) body.hydrostatic = body.surfaces == 0 || body.lifted <= body.plain;
  forEachActiveRow(rows, [&](const ActiveRow& row) {
    for (int k = row.begin; k < row.end; ++k) {
      const std::int32_t n = component(row.i, row.j, k);
      if (n >= 0 && !components[n].hydrostatic) rhs(row.i, row.j, k) = plainRhs(row.i, row.j, k);
    }
  });
}

/// Takes the mean of `field` off every component without air; returns the largest mean.
double Projection::Internals::centreAirless(DenseField<double>& field) {
  if (std::all_of(components.begin(), components.end(), [](const Component& c) { return c.surfaces > 0; }))
    return 0;
  const auto eachAirless = [&](const auto& body) {
    for (const ActiveRow& row : multigrid.finest().rows)
      for (int k = row.begin; k < row.end; ++k) {
        const std::int32_t n = component(row.i, row.j, k);
        if (n >= 0 && components[n].surfaces == 0) body(components[n], field(row.i, row.j, k));
      }
  };
  for (Component& body : components) body.sum = 0;
  eachAirless([](Component& body, double value) { body.sum += value; });
  eachAirless([](const Component& body, double& value) { value -= body.mean(); });
  double worst = 0;
  for (const Component& body : components)
    if (body.surfaces == 0) worst = std::max(worst, std::abs(body.mean()));
  return worst;
}

double Projection::Internals::scaleOfRightHandSide() const {
  const PressureMatrix& matrix = multigrid.finest();
  return reduceActiveRows(
      matrix.rows,
      [&](const ActiveRow& row) {
        double scale = 0;
        for (int k = row.begin; k < row.end; ++k) {
          const double relief = std::min(1.0, kFullDiagonal * matrix.inverseDiagonal(row.i, row.j, k));
          scale = std::max(scale, relief * std::abs(rhs(row.i, row.j, k)));
        }
        return scale;
      },
      [](double a, double b) { return std::max(a, b); });
}

/// u + dt g - (dt/rho) grad p on an open face that borders an unknown; `c` is the cell on its upper side.
double Projection::Internals::projectedFace(const Eigen::Vector3i& c, int axis, double u) const {
  const Eigen::Vector3i lower = c - Eigen::Vector3i::Unit(axis);
  const bool upperWet = component(c) >= 0, lowerWet = component(lower) >= 0;
  const Eigen::Vector3i& wet = upperWet ? c : lower;
  const Component& body = components[component(wet)];
  const double falling = body.hydrostatic ? u : u + dt * params.gravity[axis];
  if (upperWet && lowerWet) return falling - (solution(c) - solution(lower));
  const int side = upperWet ? -1 : 1;
  const Surface known = surfaceBeside(wet, axis, side);
  const double rise = surfaceValue(body, wet, axis, side, known.theta) - solution(wet);
  return falling - side * known.coefficient / openTowards(wet, axis, side) * rise;
}

void Projection::Internals::updateVelocity(int axis, DenseField<float>& velocity,
                                           DenseField<float>& gradient) {
  const double rate = 1 / dt, g = params.gravity[axis];
  const int last = grid.cells[axis];
  forEachCell(velocity.size(), [&](int i, int j, int k) {
    const Eigen::Vector3i c(i, j, k);
    const bool wet = component(c) >= 0 || component(c - Eigen::Vector3i::Unit(axis)) >= 0;
    const bool open = boundary->open[axis](c) > 0, given = boundary->prescribed[axis](c) != 0;
    const bool wall = !open && !given && (c[axis] == 0 || c[axis] == last);
    valid[axis](c) = given || (wet && (open || wall));
    gradient(c) = 0;
    if (!wet) return;
    if (open) {
      const double projected = projectedFace(c, axis, velocity(c));
      gradient(c) = static_cast<float>(params.density * (g - rate * (projected - velocity(c))));
      velocity(c) = static_cast<float>(projected);
    } else if (wall) {
      velocity(c) = boundary->velocity[axis](c);
    }
  });
}

void Projection::Internals::writePressure() {
  const double toPressure = params.density * grid.dx / dt;
  forEachCell(grid.cells, [&](int i, int j, int k) {
    const Eigen::Vector3i c(i, j, k);
    const std::int32_t n = component(c);
    double p = 0;
    if (n >= 0) p = toPressure * solution(c);
    if (n >= 0 && components[n].hydrostatic) p += params.density * (gravityAt(c) - components[n].level);
    pressure(c) = static_cast<float>(p);
  });
}

double Projection::Internals::largestDivergence(const MacVelocity& velocity,
                                                const DenseField<float>& source) const {
  return reduceActiveRows(
      multigrid.finest().rows,
      [&](const ActiveRow& row) {
        double worst = 0;
        for (int k = row.begin; k < row.end; ++k) {
          const Eigen::Vector3i c(row.i, row.j, k);
          if (component(c) < 0) continue;
          double outflow = -source(c) * grid.dx;
          for (int a = 0; a < 3; ++a)
            for (int side : {-1, 1}) {
              const Eigen::Vector3i face = side > 0 ? c + Eigen::Vector3i::Unit(a) : c;
              const double open = boundary->open[a](face);
              outflow += side * (open * velocity[a](face) + (1 - open) * boundary->velocity[a](face));
            }
          worst = std::max(worst, std::abs(outflow));
        }
        return worst;
      },
      [](double a, double b) { return std::max(a, b); });
}

Projection::Projection(const GridSpec& grid, const FluidParams& params)
    : internals_(std::make_unique<Internals>(grid, params)) {}
Projection::~Projection() = default;
Projection::Projection(Projection&&) noexcept = default;

ProjectionReport Projection::project(const DenseField<float>& phi, const SolidBoundary& boundary, double dt,
                                     const DenseField<float>& divergenceSource, MacVelocity& velocity,
                                     MacField<float>& pressureGradient) {
  Internals& in = *internals_;
  in.phi = &phi;
  in.boundary = &boundary;
  in.dt = dt;
  in.findComponents();
  in.assembleMatrix();
  in.findLevels();
  in.assembleRightHandSide(velocity, divergenceSource);
  in.chooseGravity();

  ProjectionReport report;
  report.incompatible = in.centreAirless(in.rhs);
  const double scale = in.scaleOfRightHandSide();
  const double tolerance = std::max(kRest, in.params.pressureTolerance * scale);
  const SolveReport solve =
      in.solver.solve(in.multigrid, in.rhs, in.solution, tolerance, in.params.pressureIterations);
  if (!solve.converged) throw NumericalFailure(failure(solve, tolerance, dt));
  in.centreAirless(in.solution);

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
