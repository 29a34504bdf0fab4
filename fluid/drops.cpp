#include "fluid/drops.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "fluid/sampling.h"

namespace spume::fluid {
namespace {

/// Height above the surface at which a negative marker is a drop [cells]: nearer, the grid may still take it
/// back.
constexpr float kLaunchHeight = 1;
/// Longest way without a look at solids and liquid [dx]: half of the thinnest wall.
constexpr double kLongestWay = 0.5;

/// Position in cell units, kept where psi has values.
Eigen::Vector3f centred(const GridSpec& grid, const Eigen::Vector3d& world) {
  const Eigen::Vector3f top = grid.cells.cast<float>() - Eigen::Vector3f::Constant(0.5f);
  return grid.toCells(world).cast<float>().cwiseMax(0.5f).cwiseMin(top);
}

/// The cell that holds a point, the nearest one outside the grid.
Eigen::Vector3i cellOf(const GridSpec& grid, const Eigen::Vector3d& world) {
  return grid.toCells(world).array().floor().cast<int>().max(0).min(grid.cells.array() - 1);
}

/// Pushes a drop out of the nearest solid and takes the velocity into it.
void slideOff(const MarkerScene& scene, const FieldView& psi, Drop& drop) {
  const Eigen::Vector3f at = centred(scene.grid, drop.position);
  const ValueAndGradient wall = sampleCentredGradient(psi, at.x(), at.y(), at.z());
  if (wall.value >= 0) return;
  Eigen::Vector3d normal(wall.gx, wall.gy, wall.gz);
  const double slope = normal.norm() / scene.grid.dx;
  if (slope <= 0) return;
  normal.normalize();
  drop.position -= wall.value / std::max(slope, 0.5) * normal;
  drop.velocity -= std::min(0.0, drop.velocity.dot(normal)) * normal;
}

/// Keeps a drop inside the closed sides of the domain; false if it flew out of an open one.
bool keepInside(const MarkerScene& scene, Drop& drop) {
  const Eigen::Vector3d low = scene.grid.origin, high = scene.grid.upper();
  for (int a = 0; a < 3; ++a) {
    if (drop.position[a] < low[a]) {
      if (!scene.walls.closed[2 * a]) return false;
      drop.position[a] = low[a];
      drop.velocity[a] = std::max(0.0, drop.velocity[a]);
    } else if (drop.position[a] > high[a]) {
      if (!scene.walls.closed[2 * a + 1]) return false;
      drop.position[a] = high[a];
      drop.velocity[a] = std::min(0.0, drop.velocity[a]);
    }
  }
  return true;
}

/// Ends a drop's way at a thin wall it met and takes the velocity into it.
void keepOnSide(const MarkerScene& scene, const Eigen::Vector3d& from, Drop& drop) {
  const auto cells = [&](const Eigen::Vector3d& x) -> Eigen::Vector3f {
    return scene.grid.toCells(x).cast<float>();
  };
  const Eigen::Vector3i start = cellOf(scene.grid, from);
  const bool held = scene.solids.hasOpenFace(start.x(), start.y(), start.z());
  if (!held || !(scene.solids.sides.guard(start) & WallSides::kInReach)) return;
  const Walk walk = walkThroughFaces(scene.solids, start, cells(from), cells(drop.position));
  for (int a = 0; a < 3; ++a) {
    if (!walk.stopped[a]) continue;
    drop.position[a] = scene.grid.toWorld(walk.at.cast<double>())[a];
    drop.velocity[a] = 0;
  }
}

/// phi at a drop as the side of its cell sees it [m].
float surfaceAt(const MarkerScene& scene, const DenseField<float>& phi, const Drop& drop) {
  const Eigen::Vector3f at = scene.grid.toCells(drop.position).cast<float>();
  const Eigen::Vector3i cell = cellOf(scene.grid, drop.position);
  const WallSides& sides = scene.solids.sides;
  if (sides.guard(cell) & WallSides::kBeside) return sides.valueIn(phi, cell, at);
  return sampleCentred(FieldView(phi), at.x(), at.y(), at.z());
}

enum class Fate { flies, landed, left };

Fate flyOne(const MarkerScene& scene, const DenseField<float>& phi, const FieldView& psi, double dt,
            Drop& drop) {
  const double way = dt * (drop.velocity.norm() + dt * scene.params.gravity.norm());
  const int pieces = std::max(1, static_cast<int>(std::ceil(way / (kLongestWay * scene.grid.dx))));
  const double h = dt / pieces;
  for (int n = 0; n < pieces; ++n) {
    const Eigen::Vector3d from = drop.position;
    drop.position += h * drop.velocity + 0.5 * h * h * scene.params.gravity;
    drop.velocity += h * scene.params.gravity;
    if (!keepInside(scene, drop)) return Fate::left;
    slideOff(scene, psi, drop);
    keepOnSide(scene, from, drop);
    if (surfaceAt(scene, phi, drop) < 0) return Fate::landed;
  }
  return Fate::flies;
}

}  // namespace

double Drops::refreshVolumes(const MarkerScene& scene, const DenseField<float>& phi,
                             const MarkerSet& positive, MarkerSet& negative) {
  return shares_.refreshLiquid(scene, phi, positive, negative);
}

std::vector<Drop> Drops::launch(const MarkerScene& scene, const DenseField<float>& phi,
                                const MacVelocity& velocity, MarkerSet& negative) {
  const MacView wind(velocity);
  std::vector<Drop> launched;
  lost_.forEach(scene, phi, MarkerSign::negative, kLaunchHeight, negative, [&](std::int32_t n) {
    const float x = negative.x[n], y = negative.y[n], z = negative.z[n];
    const Velocity3f u = sampleVelocity(wind, x, y, z);
    launched.push_back({scene.grid.toWorld({x, y, z}), {u.x, u.y, u.z}, negative.gas[n]});
    negative.x[n] = std::numeric_limits<float>::quiet_NaN();
  });
  if (!launched.empty()) sorter_.compact(negative);
  return launched;
}

DropFlight fly(const MarkerScene& scene, const DenseField<float>& phi, double dt, std::vector<Drop>& drops) {
  const FieldView psi(scene.solids.psi);
  std::vector<Fate> fates(drops.size());
  tbb::parallel_for(std::size_t{0}, drops.size(),
                    [&](std::size_t n) { fates[n] = flyOne(scene, phi, psi, dt, drops[n]); });
  DropFlight flight;
  std::size_t kept = 0;
  for (std::size_t n = 0; n < drops.size(); ++n) {
    const Drop drop = drops[n];
    switch (fates[n]) {
      case Fate::flies:
        drops[kept++] = drop;
        break;
      case Fate::landed:
        flight.landed.push_back(drop);
        break;
      case Fate::left:
        flight.left += drop.volume;
        break;
    }
  }
  drops.resize(kept);
  return flight;
}

double volumeOf(const std::vector<Drop>& drops) {
  double sum = 0;
  for (const Drop& drop : drops) sum += drop.volume;
  return sum;
}

Eigen::Vector3d momentumOf(const std::vector<Drop>& drops, double density) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Drop& drop : drops) sum += density * drop.volume * drop.velocity;
  return sum;
}

void depositMomentum(const GridSpec& grid, const std::vector<Drop>& landed, MacVelocity& velocity) {
  for (const Drop& drop : landed) {
    const double share = 0.5 * std::min(drop.volume / grid.cellVolume(), 1.0);
    const Eigen::Vector3i cell = cellOf(grid, drop.position);
    for (int a = 0; a < 3; ++a)
      for (const Eigen::Vector3i& face : {cell, Eigen::Vector3i(cell + Eigen::Vector3i::Unit(a))}) {
        float& u = velocity[a](face);
        u += static_cast<float>(share * (drop.velocity[a] - u));
      }
  }
}

}  // namespace spume::fluid
