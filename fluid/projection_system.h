#pragma once

#include <cstdint>
#include <vector>

#include "fluid/conjugate_gradient.h"
#include "fluid/connected_cells.h"
#include "fluid/face_rows.h"
#include "fluid/multigrid.h"
#include "fluid/pocket_unknowns.h"
#include "fluid/pressure_rows.h"
#include "fluid/projection.h"

namespace spume::fluid {

/// A set of unknowns joined by the matrix.
struct Component {
  double level =
      0;  // mean of g.x over its open surface, else over that to pockets, else over its cells [m^2/s^2]
  std::ptrdiff_t surfaces = 0;      // faces with air behind
  std::ptrdiff_t openSurfaces = 0;  // of them, those with open air behind
  std::ptrdiff_t cells = 0;
  double lifted = 0, plain = 0;  // squared right-hand sides without and with gravity
  double sum = 0;                // of the right-hand side, then of the solution
  bool hydrostatic = true;       // solved without gravity, less the hydrostatic pressure
  double mean() const { return sum / static_cast<double>(cells); }
};

/// Part of a component's squared right-hand sides.
struct SquareSum {
  std::int32_t component;
  double lifted, plain;
};

/// Where the pressure is known next to a liquid cell.
struct Surface {
  float coefficient;  // open / theta of its face
  double theta;       // true distance from the cell's centre [dx]
};

/// What flows out of the cells [begin, end) of a row through their faces, over dx^2 [m/s].
void outflowOfRow(const SolidBoundary& boundary, const MacVelocity& velocity, const ActiveRow& row,
                  double* __restrict outflow);

/// Unknown: q = p dt/(rho dx) [m/s]. In a component with a surface at rest, or nearly so, q is solved for
/// less its hydrostatic part (dt/dx)(g.x - level), which cancels gravity on every face without any
/// subtraction; one that falls freely is solved for as it is. Both give the same discrete solution; each is
/// exact for its own rest.
struct ProjectionSystem {
  GridSpec grid;
  FluidParams params;
  Multigrid multigrid;
  ConjugateGradient solver;
  ConnectedCells connected;
  DenseField<std::int32_t> component;
  std::vector<Component> components;
  std::vector<std::vector<Eigen::Vector3i>> surfaceCells;  // unknowns beside the surface, of each slab
  std::vector<std::vector<SquareSum>> squares;             // of each slab
  DenseField<double> rhs, plainRhs, solution;
  PocketUnknowns pockets;
  std::vector<double>
      pocketPressure;                // of each pocket, in the unit of q [m/s]; the known part until the solve
  std::vector<std::uint8_t> vented;  // pockets that count as open air
  MacField<std::uint8_t> valid;
  DenseField<float> pressure;
  DenseField<float> kappa;  // curvature of the surface [1/m], with surface tension

  const DenseField<float>* phi = nullptr;  // of the call under way
  const SolidBoundary* boundary = nullptr;
  const HeldPockets* held = nullptr;  // null: no closed pocket keeps its gas
  double dt = 0;
  bool anyAirless = false;

  ProjectionSystem(const GridSpec& g, const FluidParams& p)
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
  /// g.x at the surface beside a cell [m^2/s^2].
  double gravityAtSurface(const Eigen::Vector3i& c, int axis, int side, double theta) const {
    return gravityAt(c) + side * theta * grid.dx * params.gravity[axis];
  }
  /// Closed pocket that keeps its gas on that side of a cell, -1 for open air.
  std::int32_t pocketBeside(const Eigen::Vector3i& c, int axis, int side) const {
    const std::int32_t pocket = held ? held->label(c + side * Eigen::Vector3i::Unit(axis)) : -1;
    return pocket >= 0 && !vented[pocket] ? pocket : -1;
  }
  /// Jump sigma kappa of the pressure at the surface beside a cell, in the unit of q [m/s].
  double tension(const Eigen::Vector3i& c, int axis, int side, double theta) const {
    if (params.surfaceTension == 0) return 0;
    const Eigen::Vector3i n = c + side * Eigen::Vector3i::Unit(axis);
    const double behind = kappa.contains(n.x(), n.y(), n.z()) ? kappa(n) : kappa(c);
    const double bend = (1 - theta) * kappa(c) + theta * behind;
    return params.surfaceTension * bend * dt / (params.density * grid.dx);
  }
  /// Reduced q at the surface [m/s].
  double surfaceValue(const Component& body, const Eigen::Vector3i& c, int axis, int side,
                      double theta) const {
    const std::int32_t pocket = pocketBeside(c, axis, side);
    const double gas = (pocket >= 0 ? pocketPressure[pocket] : 0) + tension(c, axis, side, theta);
    if (!body.hydrostatic) return gas;
    return gas - dt / grid.dx * (gravityAtSurface(c, axis, side, theta) - body.level);
  }

  Surface surfaceBeside(const Eigen::Vector3i& c, int axis, int side) const;
  void findComponents();
  void assembleMatrix();
  void findLevels();
  float excessOf(const Eigen::Vector3i& c) const;
  double surfaceTerm(const Eigen::Vector3i& c) const;
  double tensionTerm(const Eigen::Vector3i& c) const;
  void findPocketSurfaces();
  void ventSealedPockets(const std::vector<std::uint8_t>& openBodies);
  void levelPockets();
  void relevelPockets();
  void assemblePockets(const MacVelocity& velocity);
  double solidFlowInto(const AirPocket& pocket) const;
  void assembleRow(const ActiveRow& row, const MacVelocity& velocity, const DenseField<float>& source);
  void updateFace(const Eigen::Vector3i& c, int axis, float& velocity, float& gradient);
  /// Calls body(component, cell) for every unknown, in order.
  template <typename Body>
  void forEachUnknown(const Body& body) {
    for (const ActiveRow& row : multigrid.finest().rows)
      for (int k = row.begin; k < row.end; ++k) {
        const std::int32_t n = component(row.i, row.j, k);
        if (n >= 0) body(components[n], Eigen::Vector3i(row.i, row.j, k));
      }
  }
  /// The same for those beside the surface.
  template <typename Body>
  void forEachSurfaceCell(const Body& body) {
    for (const std::vector<Eigen::Vector3i>& slab : surfaceCells)
      for (const Eigen::Vector3i& c : slab) body(components[component(c)], c);
  }
  void sumSquares(const ActiveRow& row, std::vector<SquareSum>& sums) const;
  void assembleRightHandSide(const MacVelocity& velocity, const DenseField<float>& source);
  void chooseGravity();
  double centreAirless(DenseField<double>& field);
  double scaleOfRightHandSide() const;
  double projectedFace(const Eigen::Vector3i& c, int axis, double u) const;
  void updateRun(int axis, bool hydrostatic, const double* above, const double* below, int count,
                 float* velocity, float* gradient) const;
  void updateVelocity(int axis, DenseField<float>& velocity, DenseField<float>& gradient);
  void writePressure();
  double largestDivergence(const MacVelocity& velocity, const DenseField<float>& source);
};

}  // namespace spume::fluid
