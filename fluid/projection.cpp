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

/// The rows of a face field that bound a row of cells: [side] across x and y, and the minus faces across z.
struct FaceRows {
  const float* x[2];
  const float* y[2];
  const float* z;
  FaceRows(const MacField<float>& field, int i, int j)
      : x{&field[0](i, j, 0), &field[0](i + 1, j, 0)},
        y{&field[1](i, j, 0), &field[1](i, j + 1, 0)},
        z(&field[2](i, j, 0)) {}
};

/// What flows out of the cells [begin, end) of a row through their faces, over dx^2 [m/s].
void outflowOfRow(const SolidBoundary& boundary, const MacVelocity& velocity, const ActiveRow& row,
                  double* __restrict outflow) {
  const FaceRows open(boundary.open, row.i, row.j), solid(boundary.velocity, row.i, row.j);
  const FaceRows u(velocity, row.i, row.j);
  const auto flow = [](double f, double fluid, double wall) { return f * fluid + (1 - f) * wall; };
  for (int k = row.begin; k < row.end; ++k)
    outflow[k] = flow(open.x[1][k], u.x[1][k], solid.x[1][k]) - flow(open.x[0][k], u.x[0][k], solid.x[0][k]) +
                 flow(open.y[1][k], u.y[1][k], solid.y[1][k]) - flow(open.y[0][k], u.y[0][k], solid.y[0][k]) +
                 flow(open.z[k + 1], u.z[k + 1], solid.z[k + 1]) - flow(open.z[k], u.z[k], solid.z[k]);
}

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
  bool anyAirless = false;

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
  float excessOf(const Eigen::Vector3i& c) const;
  double surfaceTerm(const Eigen::Vector3i& c) const;
  void assembleRow(const ActiveRow& row, const MacVelocity& velocity, const DenseField<float>& source);
  void updateFace(const Eigen::Vector3i& c, int axis, float& velocity, float& gradient);
  template <typename Body>
  void forEachUnknown(const Body& body);
  void assembleRightHandSide(const MacVelocity& velocity, const DenseField<float>& source);
  void chooseGravity();
  double centreAirless(DenseField<double>& field);
  double scaleOfRightHandSide() const;
  double projectedFace(const Eigen::Vector3i& c, int axis, double u) const;
  void updateVelocity(int axis, DenseField<float>& velocity, DenseField<float>& gradient);
  void writePressure();
  double largestDivergence(const MacVelocity& velocity, const DenseField<float>& source);
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

/// Couplings of a wet cell to known pressures.
float Projection::Internals::excessOf(const Eigen::Vector3i& c) const {
  float excess = 0;
  for (int a = 0; a < 3; ++a)
    for (int side : {-1, 1})
      if (isSurface(c, a, side)) excess += surfaceBeside(c, a, side).coefficient;
  return excess;
}

void Projection::Internals::assembleMatrix() {
  PressureMatrix& matrix = multigrid.finest();
  const auto si = component.stride(0), sj = component.stride(1);
  forEachRow(grid.cells, [&](int i, int j) {
    const std::int32_t* wet = &component(i, j, 0);
    const FaceRows open(boundary->open, i, j);
    float *wx = &matrix.weight[0](i, j, 0), *wy = &matrix.weight[1](i, j, 0),
          *wz = &matrix.weight[2](i, j, 0);
    float* excess = &matrix.excess(i, j, 0);
    for (int k = 0; k < grid.cells.z(); ++k) {
      wx[k] = (wet[k] | wet[k - si]) >= 0 ? open.x[0][k] : 0;  // no label has its sign bit set: both are wet
      wy[k] = (wet[k] | wet[k - sj]) >= 0 ? open.y[0][k] : 0;
      wz[k] = (wet[k] | wet[k - 1]) >= 0 ? open.z[k] : 0;
      excess[k] = 0;
    }
    for (int k = 0; k < grid.cells.z(); ++k) {
      const bool inside =
          (wet[k - si] | wet[k + si] | wet[k - sj] | wet[k + sj] | wet[k - 1] | wet[k + 1]) >= 0;
      if (wet[k] >= 0 && !inside) excess[k] = excessOf({i, j, k});
    }
  });
  matrix.finish();
  multigrid.coarsen();
}

/// Calls body(component, cell) for every unknown, in order.
template <typename Body>
void Projection::Internals::forEachUnknown(const Body& body) {
  for (const ActiveRow& row : multigrid.finest().rows)
    for (int k = row.begin; k < row.end; ++k) {
      const std::int32_t n = component(row.i, row.j, k);
      if (n >= 0) body(components[n], Eigen::Vector3i(row.i, row.j, k));
    }
}

void Projection::Internals::findLevels() {
  const DenseField<float>& excess = multigrid.finest().excess;
  forEachUnknown([&](Component& body, const Eigen::Vector3i& c) {
    if (!(excess(c) > 0)) return;
    for (int a = 0; a < 3; ++a)
      for (int side : {-1, 1}) {
        if (!isSurface(c, a, side)) continue;
        ++body.surfaces;
        body.level += gravityAt(c) + side * surfaceBeside(c, a, side).theta * grid.dx * params.gravity[a];
      }
  });
  anyAirless = false;
  for (Component& body : components) {
    anyAirless = anyAirless || body.surfaces == 0;
    if (body.surfaces > 0) body.level /= static_cast<double>(body.surfaces);
  }
  if (!anyAirless) return;
  forEachUnknown([&](Component& body, const Eigen::Vector3i& c) {
    ++body.cells;
    if (body.surfaces == 0) body.level += gravityAt(c);
  });
  for (Component& body : components)
    if (body.surfaces == 0) body.level /= static_cast<double>(body.cells);
}

/// Sum over the surface beside a cell of coefficient times known reduced pressure.
double Projection::Internals::surfaceTerm(const Eigen::Vector3i& c) const {
  const Component& body = components[component(c)];
  double sum = 0;
  for (int a = 0; a < 3; ++a)
    for (int side : {-1, 1}) {
      if (!isSurface(c, a, side)) continue;
      const Surface known = surfaceBeside(c, a, side);
      sum += known.coefficient * surfaceValue(body, c, a, side, known.theta);
    }
  return sum;
}

void Projection::Internals::assembleRow(const ActiveRow& row, const MacVelocity& velocity,
                                        const DenseField<float>& source) {
  const std::int32_t* wet = &component(row.i, row.j, 0);
  const float* excess = &multigrid.finest().excess(row.i, row.j, 0);
  const float* sources = &source(row.i, row.j, 0);
  const FaceRows open(boundary->open, row.i, row.j);
  const Eigen::Vector3d fall = dt * params.gravity;
  double* __restrict lifted = &rhs(row.i, row.j, 0);
  double* __restrict plain = &plainRhs(row.i, row.j, 0);
  outflowOfRow(*boundary, velocity, row, lifted);
  for (int k = row.begin; k < row.end; ++k) {
    const double inflow = wet[k] >= 0 ? sources[k] * grid.dx - lifted[k] : 0;
    const double falling = fall.x() * (open.x[1][k] - open.x[0][k]) +
                           fall.y() * (open.y[1][k] - open.y[0][k]) + fall.z() * (open.z[k + 1] - open.z[k]);
    lifted[k] = inflow;
    plain[k] = wet[k] >= 0 ? inflow - falling : 0;
  }
  for (int k = row.begin; k < row.end; ++k)
    if (excess[k] > 0) lifted[k] += surfaceTerm({row.i, row.j, k});
}

void Projection::Internals::assembleRightHandSide(const MacVelocity& velocity,
                                                  const DenseField<float>& source) {
  forEachActiveRow(multigrid.finest().rows,
                   [&](const ActiveRow& row) { assembleRow(row, velocity, source); });
}

/// Decides for each component which form has the smaller right-hand side.
void Projection::Internals::chooseGravity() {
  forEachUnknown([&](Component& body, const Eigen::Vector3i& c) {
    body.lifted += rhs(c) * rhs(c);
    body.plain += plainRhs(c) * plainRhs(c);
  });
  bool allLifted = true;
  for (Component& body : components) {
    body.hydrostatic = body.surfaces == 0 || body.lifted <= body.plain;
    allLifted = allLifted && body.hydrostatic;
  }
  if (allLifted) return;
  forEachUnknown([&](const Component& body, const Eigen::Vector3i& c) {
    if (!body.hydrostatic) rhs(c) = plainRhs(c);
  });
}

/// Takes the mean of `field` off every component without air; returns the largest mean.
double Projection::Internals::centreAirless(DenseField<double>& field) {
  if (!anyAirless) return 0;
  for (Component& body : components) body.sum = 0;
  forEachUnknown([&](Component& body, const Eigen::Vector3i& c) { body.sum += field(c); });
  forEachUnknown([&](const Component& body, const Eigen::Vector3i& c) {
    if (body.surfaces == 0) field(c) -= body.mean();
  });
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

/// u + dt g - (dt/rho) grad p on an open face between an unknown and air; `c` is the cell on its upper side.
double Projection::Internals::projectedFace(const Eigen::Vector3i& c, int axis, double u) const {
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
void Projection::Internals::updateFace(const Eigen::Vector3i& c, int axis, float& velocity, float& gradient) {
  const bool open = boundary->open[axis](c) > 0, given = boundary->prescribed[axis](c) != 0;
  const bool wall = !open && !given && (c[axis] == 0 || c[axis] == grid.cells[axis]);
  valid[axis](c) = given || open || wall;
  if (wall) velocity = boundary->velocity[axis](c);
  if (!open) return;
  const double projected = projectedFace(c, axis, velocity);
  gradient = static_cast<float>(params.density * (params.gravity[axis] - (projected - velocity) / dt));
  velocity = static_cast<float>(projected);
}

void Projection::Internals::updateVelocity(int axis, DenseField<float>& velocity,
                                           DenseField<float>& gradient) {
  const auto step = component.stride(axis), stepBack = solution.stride(axis);
  const double fall = dt * params.gravity[axis], toGradient = params.density / dt;
  const Eigen::Vector3i& size = velocity.size();
  forEachRow(size, [&](int i, int j) {
    const std::int32_t* wet = &component(i, j, 0);
    const std::uint8_t* given = &boundary->prescribed[axis](i, j, 0);
    const float* open = &boundary->open[axis](i, j, 0);
    const double* q = &solution(i, j, 0);
    float *u = &velocity(i, j, 0), *g = &gradient(i, j, 0);
    std::uint8_t* set = &valid[axis](i, j, 0);
    for (int k = 0; k < size.z(); ++k) {
      g[k] = 0;
      if ((wet[k] | wet[k - step]) >= 0 && open[k] > 0) {  // both sides wet: most faces
        const double push = q[k] - q[k - stepBack], pull = components[wet[k]].hydrostatic ? fall : 0;
        u[k] = static_cast<float>(u[k] + (fall - pull - push));
        g[k] = static_cast<float>(toGradient * (pull + push));
        set[k] = 1;
      } else if (wet[k] >= 0 || wet[k - step] >= 0) {
        updateFace({i, j, k}, axis, u[k], g[k]);
      } else {
        set[k] = given[k];
      }
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
                                                const DenseField<float>& source) {
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
