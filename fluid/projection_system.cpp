#include "fluid/projection_system.h"

#include <algorithm>
#include <cmath>

#include "fluid/parallel.h"

namespace spume::fluid {
namespace {

// Least distance of the surface from a liquid cell's centre [dx]: bounds the matrix's condition (model,
// Section 3).
constexpr double kLeastTheta = 0.01;
// The same for a face almost shut by a solid [dx]: kLeastThetaShut (1 - open). The cell's other faces
// outweigh one that is hardly open, and its pressure does not come near that of a surface which is; over a
// true theta of 0.01 the difference would drive liquid through the slit at ten times the speed around it.
constexpr double kLeastThetaShut = 0.5;
// Distance of an open domain boundary from the centres beside it [dx].
constexpr double kBoundaryTheta = 0.5;
// The residual is compared with the right-hand side scaled to this diagonal: six full neighbours. Without it
// a single cell grazed by the surface (1/theta = 100) would loosen the tolerance of all others.
constexpr double kFullDiagonal = 6;

}  // namespace

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

Surface ProjectionSystem::surfaceBeside(const Eigen::Vector3i& c, int axis, int side) const {
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
  const double least = std::max(kLeastTheta, kLeastThetaShut * (1 - open));
  return {static_cast<float>(open / std::max(theta, least)), theta};
}

void ProjectionSystem::findComponents() {
  const SolidBoundary& solid = *boundary;
  const int count = connected.label(
      grid.cells, [&](int i, int j, int k) { return (*phi)(i, j, k) < 0 && solid.hasOpenFace(i, j, k); },
      [&](int axis, int i, int j, int k) { return solid.open[axis](i, j, k) > 0; }, component);
  components.assign(count, Component{});
}

/// Couplings of a wet cell to known pressures.
float ProjectionSystem::excessOf(const Eigen::Vector3i& c) const {
  float excess = 0;
  for (int a = 0; a < 3; ++a)
    for (int side : {-1, 1})
      if (isSurface(c, a, side)) excess += surfaceBeside(c, a, side).coefficient;
  return excess;
}

void ProjectionSystem::assembleMatrix() {
  PressureMatrix& matrix = multigrid.finest();
  const auto si = component.stride(0), sj = component.stride(1);
  surfaceCells.resize(grid.cells.x());
  forEachRow(grid.cells, [&](int i, int j) {
    if (j == 0) surfaceCells[i].clear();
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
      if (wet[k] < 0 || inside) continue;
      excess[k] = excessOf({i, j, k});
      if (excess[k] > 0) surfaceCells[i].emplace_back(i, j, k);
    }
  });
  matrix.finish();
  multigrid.coarsen();
}

void ProjectionSystem::findLevels() {
  std::vector<double> inPockets(components.size(), 0);
  forEachSurfaceCell([&](Component& body, const Eigen::Vector3i& c) {
    for (int a = 0; a < 3; ++a)
      for (int side : {-1, 1}) {
        if (!isSurface(c, a, side)) continue;
        const bool open = pocketBeside(c, a, side) < 0;
        ++body.surfaces;
        body.openSurfaces += open;
        const double there = gravityAtSurface(c, a, side, surfaceBeside(c, a, side).theta);
        (open ? body.level : inPockets[component(c)]) += there;
      }
  });
  anyAirless = false;
  for (std::size_t n = 0; n < components.size(); ++n) {
    Component& body = components[n];
    anyAirless = anyAirless || body.surfaces == 0;
    if (body.openSurfaces > 0)
      body.level /= static_cast<double>(body.openSurfaces);
    else if (body.surfaces > 0)
      body.level = inPockets[n] / static_cast<double>(body.surfaces);
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
double ProjectionSystem::surfaceTerm(const Eigen::Vector3i& c) const {
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

/// The part of surfaceTerm that surface tension gives, the only one in a body that falls freely.
double ProjectionSystem::tensionTerm(const Eigen::Vector3i& c) const {
  double sum = 0;
  for (int a = 0; a < 3; ++a)
    for (int side : {-1, 1}) {
      if (!isSurface(c, a, side)) continue;
      const Surface known = surfaceBeside(c, a, side);
      sum += known.coefficient * tension(c, a, side, known.theta);
    }
  return sum;
}

void ProjectionSystem::assembleRow(const ActiveRow& row, const MacVelocity& velocity,
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
  for (int k = row.begin; k < row.end; ++k) {
    if (!(excess[k] > 0)) continue;
    lifted[k] += surfaceTerm({row.i, row.j, k});
    if (params.surfaceTension > 0) plain[k] += tensionTerm({row.i, row.j, k});
  }
}

void ProjectionSystem::assembleRightHandSide(const MacVelocity& velocity, const DenseField<float>& source) {
  forEachActiveRow(multigrid.finest().rows,
                   [&](const ActiveRow& row) { assembleRow(row, velocity, source); });
}

/// Squares of both right-hand sides along the stretches of a row that belong to one component.
void ProjectionSystem::sumSquares(const ActiveRow& row, std::vector<SquareSum>& sums) const {
  for (int k = row.begin; k < row.end; ++k) {
    const std::int32_t n = component(row.i, row.j, k);
    if (n < 0) continue;
    if (sums.empty() || sums.back().component != n) sums.push_back({n, 0, 0});
    const double lifted = rhs(row.i, row.j, k), plain = plainRhs(row.i, row.j, k);
    sums.back().lifted += lifted * lifted;
    sums.back().plain += plain * plain;
  }
}

/// Decides for each component which form has the smaller right-hand side.
void ProjectionSystem::chooseGravity() {
  const PressureMatrix& matrix = multigrid.finest();
  squares.resize(grid.cells.x());
  tbb::parallel_for(0, grid.cells.x(), [&](int i) {
    squares[i].clear();
    const int first = i * grid.cells.y();
    for (int n = matrix.rowStart[first]; n < matrix.rowStart[first + grid.cells.y()]; ++n)
      sumSquares(matrix.rows[n], squares[i]);
  });
  for (const std::vector<SquareSum>& slab : squares)
    for (const SquareSum& sum : slab) {
      components[sum.component].lifted += sum.lifted;
      components[sum.component].plain += sum.plain;
    }
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
double ProjectionSystem::centreAirless(DenseField<double>& field) {
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

double ProjectionSystem::scaleOfRightHandSide() const {
  const PressureMatrix& matrix = multigrid.finest();
  const double cells = reduceActiveRows(
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
  return std::max(cells, pockets.largestResidual(kFullDiagonal));
}

}  // namespace spume::fluid
