#include "apps/preview/surface_mesh.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "fluid/parallel.h"

namespace spume::apps {
namespace {

using fluid::DenseField;
using fluid::GridSpec;

/// Corners of the six tetrahedra a cell splits into along its main diagonal, as offsets coded in bits x, y,
/// z: neighbouring cells then share the diagonals of their faces.
constexpr std::array<std::array<int, 4>, 6> kTetrahedra{
    {{0, 1, 3, 7}, {0, 1, 5, 7}, {0, 2, 3, 7}, {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 4, 6, 7}}};

/// Distances on the cell centres (node 1..n along an axis) and on the walls of the box (nodes 0 and n + 1).
class Lattice {
 public:
  Lattice(const GridSpec& grid, const DenseField<float>& phi, const Eigen::Vector3d& lower,
          const Eigen::Vector3d& upper)
      : size_(grid.cells + Eigen::Vector3i::Constant(2)), value_(size_) {
    for (int a = 0; a < 3; ++a) {
      coordinate_[a].resize(size_[a]);
      for (int n = 0; n < size_[a]; ++n)
        coordinate_[a][n] =
            static_cast<float>(std::clamp(grid.origin[a] + (n - 0.5) * grid.dx, lower[a], upper[a]));
    }
    fluid::forEachCell(size_, [&](int i, int j, int k) { value_(i, j, k) = onWalls(grid, phi, i, j, k); });
  }

  const Eigen::Vector3i& size() const { return size_; }
  float value(const Eigen::Vector3i& n) const { return value_(n); }
  Eigen::Vector3f position(const Eigen::Vector3i& n) const {
    return {coordinate_[0][n.x()], coordinate_[1][n.y()], coordinate_[2][n.z()]};
  }
  Eigen::Vector3f gradient(const Eigen::Vector3i& n) const {
    Eigen::Vector3f g;
    for (int a = 0; a < 3; ++a) {
      Eigen::Vector3i before = n, after = n;
      before[a] = std::max(n[a] - 1, 0);
      after[a] = std::min(n[a] + 1, size_[a] - 1);
      const float span = coordinate_[a][after[a]] - coordinate_[a][before[a]];
      g[a] = span > 0 ? (value_(after) - value_(before)) / span : 0.0f;
    }
    return g;
  }

 private:
  /// Nodes on a wall take the distance of the nearest cell: the surface meets the wall at a right angle.
  static float onWalls(const GridSpec& grid, const DenseField<float>& phi, int i, int j, int k) {
    return phi(std::clamp(i - 1, 0, grid.cells.x() - 1), std::clamp(j - 1, 0, grid.cells.y() - 1),
               std::clamp(k - 1, 0, grid.cells.z() - 1));
  }

  Eigen::Vector3i size_;
  std::array<std::vector<float>, 3> coordinate_;
  DenseField<float> value_;
};

struct Vertex {
  Eigen::Vector3f position, normal;
};

/// Where the surface crosses the edge from the inner to the outer node; independent of the cell that asks.
Vertex crossing(const Lattice& lattice, const Eigen::Vector3i& inner, const Eigen::Vector3i& outer) {
  constexpr float kOffNode = 1e-3f;  // keeps triangles away from zero area, as a share of the edge
  const float in = lattice.value(inner), out = lattice.value(outer);
  const float t = std::clamp(in / (in - out), kOffNode, 1 - kOffNode);
  const Eigen::Vector3f normal = (1 - t) * lattice.gradient(inner) + t * lattice.gradient(outer);
  const float length = normal.norm();
  const Eigen::Vector3f along = lattice.position(outer) - lattice.position(inner);
  return {lattice.position(inner) + t * along,
          length > 0 ? Eigen::Vector3f(normal / length) : along.normalized()};
}

/// Appends a triangle turned so that it faces `outward`.
void addTriangle(const Vertex& a, const Vertex& b, const Vertex& c, const Eigen::Vector3f& outward,
                 SurfaceMesh& mesh) {
  const bool facing = (b.position - a.position).cross(c.position - a.position).dot(outward) >= 0;
  for (const Vertex* v : {&a, facing ? &b : &c, facing ? &c : &b}) {
    mesh.position.push_back(v->position);
    mesh.normal.push_back(v->normal);
  }
}

void addTetrahedron(const Lattice& lattice, const std::array<Eigen::Vector3i, 4>& corner, SurfaceMesh& mesh) {
  std::array<Eigen::Vector3i, 4> inner, outer;
  int inside = 0, outside = 0;
  for (const Eigen::Vector3i& n : corner) (lattice.value(n) < 0 ? inner[inside++] : outer[outside++]) = n;
  if (inside == 0 || outside == 0) return;
  const Eigen::Vector3f outward = lattice.position(outer[0]) - lattice.position(inner[0]);
  const auto cut = [&](int in, int out) { return crossing(lattice, inner[in], outer[out]); };
  if (inside == 1) {
    addTriangle(cut(0, 0), cut(0, 1), cut(0, 2), outward, mesh);
  } else if (outside == 1) {
    addTriangle(cut(0, 0), cut(1, 0), cut(2, 0), outward, mesh);
  } else {
    addTriangle(cut(0, 0), cut(0, 1), cut(1, 1), outward, mesh);
    addTriangle(cut(0, 0), cut(1, 1), cut(1, 0), outward, mesh);
  }
}

void addCell(const Lattice& lattice, const Eigen::Vector3i& cell, SurfaceMesh& mesh) {
  std::array<Eigen::Vector3i, 8> corner;
  int inside = 0;
  for (int c = 0; c < 8; ++c) {
    corner[c] = cell + Eigen::Vector3i(c & 1, c >> 1 & 1, c >> 2 & 1);
    inside += lattice.value(corner[c]) < 0;
  }
  if (inside == 0 || inside == 8) return;
  for (const auto& t : kTetrahedra)
    addTetrahedron(lattice, {corner[t[0]], corner[t[1]], corner[t[2]], corner[t[3]]}, mesh);
}

SurfaceMesh meshSlab(const Lattice& lattice, int i) {
  SurfaceMesh mesh;
  for (int j = 0; j + 1 < lattice.size().y(); ++j)
    for (int k = 0; k + 1 < lattice.size().z(); ++k) addCell(lattice, {i, j, k}, mesh);
  return mesh;
}

using Distance = std::function<double(const Eigen::Vector3d&)>;

/// The distance at all cell centres near the surface, and its sign elsewhere: blocks that the distance at
/// their middle shows to be far from the surface take that value. Twice the reach allows for functions
/// steeper than a distance.
DenseField<float> sampleNearSurface(const Distance& distance, const GridSpec& grid) {
  constexpr int kBlock = 4;  // cells
  const double reach = 2 * std::sqrt(3.0) * (0.5 * kBlock + 1) * grid.dx;
  DenseField<float> sampled(grid.cells);
  const auto fillBlock = [&](const Eigen::Vector3i& from) {
    const Eigen::Vector3i to = (from.array() + kBlock).min(grid.cells.array());
    const Eigen::Vector3d middle =
        grid.origin + grid.dx * (from.cast<double>() + Eigen::Vector3d::Constant(0.5 * kBlock));
    const double there = distance(middle);
    for (int i = from.x(); i < to.x(); ++i)
      for (int j = from.y(); j < to.y(); ++j)
        for (int k = from.z(); k < to.z(); ++k)
          sampled(i, j, k) =
              static_cast<float>(std::abs(there) > reach ? there : distance(grid.cellCentre(i, j, k)));
  };
  tbb::parallel_for(0, (grid.cells.x() + kBlock - 1) / kBlock, [&](int slab) {
    for (int j = 0; j < grid.cells.y(); j += kBlock)
      for (int k = 0; k < grid.cells.z(); k += kBlock) fillBlock({slab * kBlock, j, k});
  });
  return sampled;
}

/// Numbers of the corners, equal ones next to each other.
std::vector<std::uint32_t> cornersInOrder(const SurfaceMesh& mesh) {
  std::vector<std::uint32_t> order(mesh.position.size());
  std::iota(order.begin(), order.end(), 0u);
  tbb::parallel_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    const Eigen::Vector3f &p = mesh.position[a], &q = mesh.position[b];
    return std::lexicographical_compare(p.data(), p.data() + 3, q.data(), q.data() + 3);
  });
  return order;
}

/// One Newton step along the gradient, but not off a wall of the box.
void moveOntoSurface(const Distance& distance, const Eigen::Vector3d& lower, const Eigen::Vector3d& upper,
                     double dx, Eigen::Vector3f& position, Eigen::Vector3f& normal) {
  constexpr double kStep = 0.05;  // of the central differences, in cells: rounds sharp edges by about as much
  const Eigen::Vector3d x = position.cast<double>();
  Eigen::Vector3d gradient;
  for (int a = 0; a < 3; ++a) {
    const Eigen::Vector3d h = kStep * dx * Eigen::Vector3d::Unit(a);
    gradient[a] = (distance(x + h) - distance(x - h)) / (2 * kStep * dx);
  }
  if (!(gradient.norm() > 0)) return;
  gradient.normalize();
  normal = gradient.cast<float>();
  const Eigen::Vector3f low = lower.cast<float>(), high = upper.cast<float>();
  const double far = std::clamp(distance(x), -dx, dx);
  for (int a = 0; a < 3; ++a)
    if (position[a] > low[a] && position[a] < high[a])
      position[a] = std::clamp(static_cast<float>(x[a] - far * gradient[a]), low[a], high[a]);
}

}  // namespace

SurfaceMesh meshLevelSet(const GridSpec& grid, const DenseField<float>& phi, const Eigen::Vector3d& lower,
                         const Eigen::Vector3d& upper) {
  const Lattice lattice(grid, phi, lower, upper);
  std::vector<SurfaceMesh> slabs(lattice.size().x() - 1);
  tbb::parallel_for(0, static_cast<int>(slabs.size()), [&](int i) { slabs[i] = meshSlab(lattice, i); });
  SurfaceMesh mesh;
  for (const SurfaceMesh& slab : slabs) {
    mesh.position.insert(mesh.position.end(), slab.position.begin(), slab.position.end());
    mesh.normal.insert(mesh.normal.end(), slab.normal.begin(), slab.normal.end());
  }
  return mesh;
}

SurfaceMesh meshDistance(const Distance& distance, const Eigen::Vector3d& lower, const Eigen::Vector3d& upper,
                         int cells) {
  GridSpec grid;
  grid.origin = lower;
  grid.dx = (upper - lower).maxCoeff() / cells;
  grid.cells = ((upper - lower) / grid.dx).array().ceil().cast<int>().max(2);
  SurfaceMesh mesh = meshLevelSet(grid, sampleNearSurface(distance, grid), lower, upper);
  const std::vector<std::uint32_t> order = cornersInOrder(mesh);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, order.size()), [&](const auto& range) {
    std::size_t n = range.begin();
    while (n < range.end()) {
      const Eigen::Vector3f place = mesh.position[order[n]];
      Vertex moved{place, mesh.normal[order[n]]};
      moveOntoSurface(distance, lower, upper, grid.dx, moved.position, moved.normal);
      for (; n < range.end() && mesh.position[order[n]] == place; ++n)
        mesh.position[order[n]] = moved.position, mesh.normal[order[n]] = moved.normal;
    }
  });
  return mesh;
}

}  // namespace spume::apps
