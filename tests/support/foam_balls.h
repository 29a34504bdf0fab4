#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <vector>

#include "foam/counter_random.h"
#include "foam/foam_topology.h"
#include "foam/power_cells.h"

namespace spume::foam::test {

/// Balls with ids 0, 1, 2 ... as the geometry engines take them.
struct Balls {
  std::vector<Eigen::Vector3d> position;
  std::vector<double> radius;
  std::vector<std::uint64_t> id;

  void add(const Eigen::Vector3d& x, double r) {
    id.push_back(position.size());
    position.push_back(x);
    radius.push_back(r);
  }
  std::size_t size() const { return position.size(); }
};

inline FoamTopology powerCellsOf(const Balls& balls) {
  FoamTopology topology;
  PowerCells().compute(balls.position, balls.radius, balls.id, topology);
  return topology;
}

inline double ballVolume(double r) { return 4 * std::numbers::pi / 3 * r * r * r; }

/// Volume of the cap of height h of a ball of radius r.
inline double capVolume(double r, double h) { return std::numbers::pi * h * h * (3 * r - h) / 3; }

inline double total(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

/// Lognormal radii (median 1, `sigma`, clipped to median / clip .. median x clip) at uniform places in a cube
/// whose volume is the balls' volume / `fraction`. A fraction of about 1 overlaps like a dense foam.
inline Balls randomFoam(int count, double sigma, double clip, double fraction, std::uint64_t seed) {
  Balls balls;
  double volume = 0;
  for (int i = 0; i < count; ++i) {
    CounterRandom random(seed, static_cast<std::uint64_t>(i), 1);
    const double normal =
        std::sqrt(-2 * std::log(1 - random.uniform())) * std::cos(2 * std::numbers::pi * random.uniform());
    const double r = std::min(std::max(std::exp(sigma * normal), 1 / clip), clip);
    volume += ballVolume(r);
    balls.add({random.uniform(), random.uniform(), random.uniform()}, r);
  }
  for (auto& x : balls.position) x *= std::cbrt(volume / fraction);
  return balls;
}

/// Balls of radius r on a block of side `cells` of the lattice with edge 1 and the given basis; index 0 is at
/// the centre.
inline Balls latticeBlock(const std::vector<Eigen::Vector3d>& basis, int cells, double r) {
  Balls balls;
  balls.add(Eigen::Vector3d::Zero(), r);
  for (int x = -cells; x <= cells; ++x)
    for (int y = -cells; y <= cells; ++y)
      for (int z = -cells; z <= cells; ++z)
        for (const auto& offset : basis) {
          const Eigen::Vector3d site = Eigen::Vector3d(x, y, z) + offset;
          if (!site.isZero()) balls.add(site, r);
        }
  return balls;
}

}  // namespace spume::foam::test
