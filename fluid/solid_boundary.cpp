#include "fluid/solid_boundary.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fluid/cut_fractions.h"
#include "fluid/parallel.h"
#include "fluid/split_cells.h"

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

using Distance = std::function<double(const Eigen::Vector3d&)>;

/// The solids that move, or those that do not, as they stand at time t.
struct Snapshot {
  std::vector<Distance> psi;
  std::vector<std::int16_t> object;

  Snapshot(const std::vector<SolidObject>& solids, bool moving, double t) {
    for (std::size_t n = 0; n < solids.size(); ++n) {
      const SolidObject& solid = solids[n];
      if (solid.moves != moving) continue;
      psi.push_back(solid.frozen ? solid.frozen(t)
                                 : [&solid, t](const Eigen::Vector3d& x) { return solid.psi(x, t); });
      object.push_back(static_cast<std::int16_t>(n));
    }
  }
};

/// nodePsi = min(nodePsi, psi of the solids).
void sampleNodes(const GridSpec& grid, const Snapshot& solids, DenseField<float>& nodePsi) {
  const double snap = kOnSurface * grid.dx;
  forEachCell(nodePsi.size(), [&](int i, int j, int k) {
    const Eigen::Vector3d x = grid.toWorld(Eigen::Vector3d(i, j, k));
    for (const Distance& distance : solids.psi) {
      const double psi = distance(x);
      const auto value = static_cast<float>(std::abs(psi) < snap ? -snap : psi);
      nodePsi(i, j, k) = std::min(nodePsi(i, j, k), value);
    }
  });
}

/// The same at cell centres, ghosts included, with the index of the nearest.
void sampleCentres(const GridSpec& grid, const Snapshot& solids, DenseField<float>& psi,
                   DenseField<std::int16_t>& object) {
  const Eigen::Vector3i padded = grid.cells + Eigen::Vector3i::Constant(2 * kGhost);
  forEachCell(padded, [&](int pi, int pj, int pk) {
    const int i = pi - kGhost, j = pj - kGhost, k = pk - kGhost;
    const Eigen::Vector3d x = grid.cellCentre(i, j, k);
    for (std::size_t n = 0; n < solids.psi.size(); ++n) {
      const auto distance = static_cast<float>(solids.psi[n](x));
      if (distance >= psi(i, j, k)) continue;
      psi(i, j, k) = distance;
      object(i, j, k) = solids.object[n];
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

bool isWall(const SolidBoundary& boundary, int axis, const Eigen::Vector3i& face) {
  return (face[axis] == 0 && boundary.walls.closed[2 * axis]) ||
         (face[axis] == boundary.open[axis].size()[axis] - 1 && boundary.walls.closed[2 * axis + 1]);
}

void openFaces(SolidBoundary& boundary) {
  for (int a = 0; a < 3; ++a) {
    boundary.prescribed[a].fill(0);
    forEachCell(boundary.open[a].size(), [&](int i, int j, int k) {
      boundary.open[a](i, j, k) =
          isWall(boundary, a, {i, j, k}) ? 0 : openFraction(boundary.nodePsi, a, i, j, k);
    });
  }
}

void moveFaces(const GridSpec& grid, const std::vector<SolidObject>& solids, double t,
               SolidBoundary& boundary) {
  const bool anyMoves =
      std::any_of(solids.begin(), solids.end(), [](const SolidObject& s) { return s.moves; });
  for (int a = 0; a < 3; ++a)
    forEachCell(boundary.velocity[a].size(), [&](int i, int j, int k) {
      const bool moved = anyMoves && boundary.open[a](i, j, k) < 1 && !isWall(boundary, a, {i, j, k});
      boundary.velocity[a](i, j, k) =
          moved ? static_cast<float>(solidVelocity(grid, solids, t, a, i, j, k)) : 0;
    });
}

void measureCells(const GridSpec& grid, SolidBoundary& boundary) {
  forEachCell(grid.cells, [&](int i, int j, int k) {
    std::array<double, 8> corner;
    for (int n = 0; n < 8; ++n) corner[n] = boundary.nodePsi(i + (n & 1), j + (n >> 1 & 1), k + (n >> 2));
    boundary.cellFraction(i, j, k) =
        boundary.hasOpenFace(i, j, k) ? static_cast<float>(cubeFraction(corner)) : 0;
  });
}

/// Everything that follows from the solids at rest and those that move, at time t.
void measure(const GridSpec& grid, const std::vector<SolidObject>& solids, double t,
             SolidBoundary& boundary) {
  boundary.nodePsi = boundary.restNodePsi;
  boundary.psi = boundary.restPsi;
  boundary.object = boundary.restObject;
  const Snapshot moving(solids, true, t);
  sampleNodes(grid, moving, boundary.nodePsi);
  sampleCentres(grid, moving, boundary.psi, boundary.object);
  openFaces(boundary);
  measureCells(grid, boundary);
  closeSplitCells(grid.cells, boundary);
  if (!solids.empty()) boundary.sides.find(boundary);
  moveFaces(grid, solids, t, boundary);
}

/// Distances to the moving solids and their velocities at the corners of the grid: no rigid motion keeps them
/// all.
std::vector<double> poseOf(const GridSpec& grid, const std::vector<SolidObject>& solids, double t) {
  std::vector<double> pose;
  for (const SolidObject& solid : solids) {
    if (!solid.moves) continue;
    for (int n = 0; n < 8; ++n) {
      const Eigen::Vector3d side(n & 1, n >> 1 & 1, n >> 2);
      const Eigen::Vector3d x = grid.origin + side.cwiseProduct(grid.upper() - grid.origin);
      const Eigen::Vector3d u = solid.velocity(x, t);
      pose.insert(pose.end(), {solid.psi(x, t), u.x(), u.y(), u.z()});
    }
  }
  return pose;
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
  boundary.shut = DenseField<std::uint8_t>(grid.cells);
  boundary.cellEdge = static_cast<float>(grid.dx);

  const Snapshot resting(solids, false, t);
  sampleNodes(grid, resting, boundary.restNodePsi);
  sampleWalls(grid, walls, boundary.restPsi);
  sampleCentres(grid, resting, boundary.restPsi, boundary.restObject);
  measure(grid, solids, t, boundary);
  return boundary;
}

bool updateSolidBoundary(const GridSpec& grid, const DomainWalls&, const std::vector<SolidObject>& solids,
                         double t, SolidBoundary& boundary) {
  if (std::none_of(solids.begin(), solids.end(), [](const SolidObject& s) { return s.moves; })) return false;
  std::vector<double> pose = poseOf(grid, solids, t);
  if (pose == boundary.pose) return false;
  boundary.pose = std::move(pose);
  measure(grid, solids, t, boundary);
  return true;
}

double fastestSolid(const GridSpec& grid, const std::vector<SolidObject>& solids,
                    const SolidBoundary& boundary, double t) {
  if (std::none_of(solids.begin(), solids.end(), [](const SolidObject& s) { return s.moves; })) return 0;
  const auto slab = [&](int i) {
    double fastest = 0;
    for (int j = 0; j < grid.cells.y(); ++j)
      for (int k = 0; k < grid.cells.z(); ++k) {
        const int n = boundary.object(i, j, k);
        if (n < 0 || !solids[n].moves || std::abs(boundary.psi(i, j, k)) > grid.dx) continue;
        fastest = std::max(fastest, solids[n].velocity(grid.cellCentre(i, j, k), t).norm());
      }
    return fastest;
  };
  return reduceSlabs(grid.cells.x(), 0.0, slab, [](double a, double b) { return std::max(a, b); });
}

}  // namespace spume::fluid
