#include "fluid/solid_boundary.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fluid/cut_fractions.h"
#include "fluid/parallel.h"

namespace spume::fluid {
namespace {

// Distance that stands for "no solid anywhere" [m].
constexpr float kFar = 1e9f;
// Corners closer to a solid than this [dx] lie on it: a solid flush with the grid would otherwise have faces
// whose openness is decided by round-off.
constexpr double kOnSurface = 1e-6;

double distanceToWalls(const GridSpec& grid, const DomainWalls& walls, const Eigen::Vector3d& x) {
  double distance = kFar;
  const Eigen::Vector3d upper = grid.upper();
  for (int a = 0; a < 3; ++a) {
    if (walls.closed[2 * a]) distance = std::min(distance, x[a] - grid.origin[a]);
    if (walls.closed[2 * a + 1]) distance = std::min(distance, upper[a] - x[a]);
  }
  return distance;
}

/// nodePsi = min(nodePsi, psi of the solids that move, or of those that do not).
void sampleNodes(const GridSpec& grid, const std::vector<SolidObject>& solids, bool moving, double t,
                 DenseField<float>& nodePsi) {
  const double snap = kOnSurface * grid.dx;
  forEachCell(nodePsi.size(), [&](int i, int j, int k) {
    const Eigen::Vector3d x = grid.toWorld(Eigen::Vector3d(i, j, k));
    for (const SolidObject& solid : solids) {
      if (solid.moves != moving) continue;
      const double psi = solid.psi(x, t);
      const auto value = static_cast<float>(std::abs(psi) < snap ? -snap : psi);
      nodePsi(i, j, k) = std::min(nodePsi(i, j, k), value);
    }
  });
}

/// The same at cell centres, ghosts included, with the index of the nearest.
void sampleCentres(const GridSpec& grid, const std::vector<SolidObject>& solids, bool moving, double t,
                   DenseField<float>& psi, DenseField<std::int16_t>& object) {
  const Eigen::Vector3i padded = grid.cells + Eigen::Vector3i::Constant(2 * kGhost);
  forEachCell(padded, [&](int pi, int pj, int pk) {
    const int i = pi - kGhost, j = pj - kGhost, k = pk - kGhost;
    const Eigen::Vector3d x = grid.cellCentre(i, j, k);
    for (std::size_t n = 0; n < solids.size(); ++n) {
      if (solids[n].moves != moving) continue;
      const auto distance = static_cast<float>(solids[n].psi(x, t));
      if (distance >= psi(i, j, k)) continue;
      psi(i, j, k) = distance;
      object(i, j, k) = static_cast<std::int16_t>(n);
    }
  });
}

void sampleWalls(const GridSpec& grid, const DomainWalls& walls, DenseField<float>& psi) {
  const Eigen::Vector3i padded = grid.cells + Eigen::Vector3i::Constant(2 * kGhost);
  forEachCell(padded, [&](int pi, int pj, int pk) {
    const int i = pi - kGhost, j = pj - kGhost, k = pk - kGhost;
    psi(i, j, k) = static_cast<float>(distanceToWalls(grid, walls, grid.cellCentre(i, j, k)));
  });
}

/// Normal velocity of the solid nearest to a face centre [m/s].
double solidVelocity(const GridSpec& grid, const std::vector<SolidObject>& solids, double t, int axis, int i,
                     int j, int k) {
  const Eigen::Vector3d x = grid.faceCentre(axis, i, j, k);
  const SolidObject* nearest = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const SolidObject& solid : solids) {
    const double psi = solid.psi(x, t);
    if (psi >= least) continue;
    least = psi;
    nearest = &solid;
  }
  return nearest && nearest->velocity ? nearest->velocity(x, t)[axis] : 0;
}

float openFraction(const DenseField<float>& node, int axis, int i, int j, int k) {
  const Eigen::Vector3i c(i, j, k);
  const Eigen::Vector3i u = Eigen::Vector3i::Unit((axis + 1) % 3), v = Eigen::Vector3i::Unit((axis + 2) % 3);
  const std::array<double, 4> corner{node(c), node(c + u), node(c + u + v), node(c + v)};
  const auto open = static_cast<float>(squareFraction(corner));
  return open < kMinOpenFraction ? 0 : open;
}

void measureFaces(const GridSpec& grid, const std::vector<SolidObject>& solids, double t,
                  SolidBoundary& boundary) {
  const bool anyMoves =
      std::any_of(solids.begin(), solids.end(), [](const SolidObject& s) { return s.moves; });
  for (int a = 0; a < 3; ++a) {
    const int last = grid.cells[a];
    boundary.prescribed[a].fill(0);
    forEachCell(boundary.open[a].size(), [&](int i, int j, int k) {
      const int n = Eigen::Vector3i(i, j, k)[a];
      const bool closed =
          (n == 0 && boundary.walls.closed[2 * a]) || (n == last && boundary.walls.closed[2 * a + 1]);
      const float open = closed ? 0 : openFraction(boundary.nodePsi, a, i, j, k);
      const bool moved = anyMoves && !closed && open < 1;
      boundary.open[a](i, j, k) = open;
      boundary.velocity[a](i, j, k) =
          moved ? static_cast<float>(solidVelocity(grid, solids, t, a, i, j, k)) : 0;
    });
  }
}

void measureCells(const GridSpec& grid, SolidBoundary& boundary) {
  forEachCell(grid.cells, [&](int i, int j, int k) {
    std::array<double, 8> corner;
    for (int n = 0; n < 8; ++n) corner[n] = boundary.nodePsi(i + (n & 1), j + (n >> 1 & 1), k + (n >> 2));
    boundary.cellFraction(i, j, k) =
        boundary.hasOpenFace(i, j, k) ? static_cast<float>(cubeFraction(corner)) : 0;
  });
}

}  // namespace

SolidBoundary buildSolidBoundary(const GridSpec& grid, const DomainWalls& walls,
                                 const std::vector<SolidObject>& solids, double t) {
  SolidBoundary boundary;
  boundary.walls = walls;
  boundary.restNodePsi = DenseField<float>(grid.cells + Eigen::Vector3i::Ones(), kFar);
  boundary.restPsi = DenseField<float>(grid.cells, kFar);
  boundary.restObject = DenseField<std::int16_t>(grid.cells, -1);
  boundary.open = MacField<float>(grid.cells);
  boundary.velocity = MacField<float>(grid.cells);
  boundary.prescribed = MacField<std::uint8_t>(grid.cells);
  boundary.cellFraction = DenseField<float>(grid.cells);

  sampleNodes(grid, solids, false, t, boundary.restNodePsi);
  sampleWalls(grid, walls, boundary.restPsi);
  sampleCentres(grid, solids, false, t, boundary.restPsi, boundary.restObject);
  boundary.nodePsi = boundary.restNodePsi;
  boundary.psi = boundary.restPsi;
  boundary.object = boundary.restObject;
  sampleNodes(grid, solids, true, t, boundary.nodePsi);
  sampleCentres(grid, solids, true, t, boundary.psi, boundary.object);
  measureFaces(grid, solids, t, boundary);
  measureCells(grid, boundary);
  return boundary;
}

void updateSolidBoundary(const GridSpec& grid, const DomainWalls&, const std::vector<SolidObject>& solids,
                         double t, SolidBoundary& boundary) {
  if (std::none_of(solids.begin(), solids.end(), [](const SolidObject& s) { return s.moves; })) return;
  boundary.nodePsi = boundary.restNodePsi;
  boundary.psi = boundary.restPsi;
  boundary.object = boundary.restObject;
  sampleNodes(grid, solids, true, t, boundary.nodePsi);
  sampleCentres(grid, solids, true, t, boundary.psi, boundary.object);
  measureFaces(grid, solids, t, boundary);
  measureCells(grid, boundary);
}

}  // namespace spume::fluid
