#pragma once

#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>

#include "fluid/dense_field.h"
#include "fluid/level_set.h"
#include "fluid/solid_boundary.h"

namespace spume::fluid::test {

using ScalarFunction = std::function<double(const Eigen::Vector3d&)>;
using VectorFunction = std::function<Eigen::Vector3d(const Eigen::Vector3d&)>;

/// n^3 cells in the unit cube.
inline GridSpec unitCube(int n) { return {Eigen::Vector3i::Constant(n), 1.0 / n, Eigen::Vector3d::Zero()}; }

inline DomainWalls openWalls() {
  DomainWalls walls;
  walls.closed.fill(false);
  return walls;
}
inline DomainWalls closedWalls() {
  DomainWalls walls;
  walls.closed.fill(true);
  return walls;
}

inline DenseField<float> levelSet(const GridSpec& grid, const ScalarFunction& phi0) {
  DenseField<float> phi;
  initialiseLevelSet(grid, phi0, phi);
  return phi;
}

inline MacVelocity macField(const GridSpec& grid, const VectorFunction& u) {
  MacVelocity velocity(grid.cells);
  for (int a = 0; a < 3; ++a)
    for (int i = 0; i < velocity[a].size().x(); ++i)
      for (int j = 0; j < velocity[a].size().y(); ++j)
        for (int k = 0; k < velocity[a].size().z(); ++k)
          velocity[a](i, j, k) = static_cast<float>(u(grid.faceCentre(a, i, j, k))[a]);
  fillGhostLayers(velocity);
  return velocity;
}

/// Calls visit(i, j, k) for the cells at least `margin` cells inside the grid.
template <typename Visit>
void forEachInner(const Eigen::Vector3i& n, int margin, const Visit& visit) {
  for (int i = margin; i < n.x() - margin; ++i)
    for (int j = margin; j < n.y() - margin; ++j)
      for (int k = margin; k < n.z() - margin; ++k) visit(i, j, k);
}

/// True if two fields hold the same bits inside the grid.
inline bool sameBits(const DenseField<float>& a, const DenseField<float>& b) {
  bool same = a.size() == b.size();
  if (same)
    forEachInner(a.size(), 0, [&](int i, int j, int k) {
      same = same && std::memcmp(&a(i, j, k), &b(i, j, k), sizeof(float)) == 0;
    });
  return same;
}

/// Runs body() on `threads` threads.
template <typename Body>
auto onThreads(int threads, const Body& body) {
  tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  return body();
}

}  // namespace spume::fluid::test
