#include "fluid/open_boundary.h"

#include <algorithm>

#include "fluid/level_set.h"

namespace spume::fluid {
namespace {

/// Lets air in through one boundary face, given the cell inside it and the step from there into the grid.
void admitThrough(const GridSpec& grid, const Eigen::Vector3i& first, const Eigen::Vector3i& inwards,
                  double front, DenseField<float>& phi) {
  Eigen::Vector3i c = first;
  const double reach = front + kLevelSetBand * grid.dx;  // behind the front phi is the distance to it
  for (double depth = 0.5 * grid.dx; depth < reach && phi.contains(c.x(), c.y(), c.z()); depth += grid.dx) {
    phi(c) = std::max(phi(c), static_cast<float>(front - depth));
    c += inwards;
  }
}

}  // namespace

void admitAir(const GridSpec& grid, const SolidBoundary& boundary, const MacVelocity& velocity, double dt,
              DenseField<float>& phi) {
  for (int a = 0; a < 3; ++a)
    for (int side : {-1, 1}) {
      if (boundary.walls.closed[2 * a + (side > 0)]) continue;
      const Eigen::Vector3i outwards = side * Eigen::Vector3i::Unit(a);
      const int b = (a + 1) % 3, d = (a + 2) % 3;
      Eigen::Vector3i c;
      c[a] = side > 0 ? grid.cells[a] - 1 : 0;
      for (c[b] = 0; c[b] < grid.cells[b]; ++c[b])
        for (c[d] = 0; c[d] < grid.cells[d]; ++c[d]) {
          const Eigen::Vector3i face = side > 0 ? c + outwards : c;
          const double inflow = boundary.open[a](face) > 0 ? -side * velocity[a](face) : 0;
          if (inflow > 0) admitThrough(grid, c, -outwards, inflow * dt, phi);
        }
    }
}

}  // namespace spume::fluid
