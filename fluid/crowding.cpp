#include "fluid/crowding.h"

#include <algorithm>
#include <cmath>

#include "fluid/face_rows.h"
#include "fluid/level_set.h"
#include "fluid/parallel.h"
#include "fluid/sampling.h"

namespace spume::fluid {
namespace {

/// Steps of a path for each cell it is long: the velocity falls to nothing within the last cell before a
/// wall.
constexpr float kStepsPerCell = 3;
constexpr int kLeastSteps = 2;
/// A path is at most so much longer than it looks from the fastest face at its end: by a factor, and in
/// cells.
constexpr float kStretch = 1.2f, kMargin = 1;
/// Largest and least density counted, relative to the liquid's: a cell is entered from six sides, at a CFL
/// number of 4, but hardly ever from all.
constexpr float kDensest = 5, kThinnest = 0;
/// Slivers of cells: what their few open faces carry is too much for their room to mean anything.
constexpr float kLeastRoom = 0.1f;
/// Cells that hold some liquid and in which phi is a distance [dx].
constexpr float kDryest = 0.5f, kDeepest = kLevelSetBand * (1 - 1e-5f);
/// How far paths stay from the upper faces of the grid [cells]: so that every point has a cell.
constexpr float kInside = 1e-3f;
/// Relative change of density that is left alone. Beyond smooth surfaces velocities diverge by such shares
/// everywhere, to both sides; what strikes something is off by whole cells.
constexpr float kNoChange = 0.01f;
/// Blocks of so many cells a side in which crowded volumes are summed, and the layer over one of their sides
/// [dx] by which the surface can be lifted without a trace: half of the largest lift.
constexpr int kBlock = 4;
constexpr float kLayer = 0.25f, kTaken = kLayer * kBlock * kBlock;

/// Stands alone so that nothing it reads can alias what it writes.
[[gnu::noinline]] void divergenceOfAirRow(const float* __restrict phi, const float* __restrict room,
                                          const FaceRows& open, const FaceRows& solid, const FaceRows& u,
                                          int count, float* __restrict divergence) {
  const auto flow = [](float f, float fluid, float wall) { return f * fluid + (1 - f) * wall; };
  for (int k = 0; k < count; ++k) {
    const float out =
        flow(open.x[1][k], u.x[1][k], solid.x[1][k]) - flow(open.x[0][k], u.x[0][k], solid.x[0][k]) +
        flow(open.y[1][k], u.y[1][k], solid.y[1][k]) - flow(open.y[0][k], u.y[0][k], solid.y[0][k]) +
        flow(open.z[k + 1], u.z[k + 1], solid.z[k + 1]) - flow(open.z[k], u.z[k], solid.z[k]);
    const bool air = (phi[k] >= 0) & (room[k] > 0);
    divergence[k] = air ? out / larger(room[k], kLeastRoom) : 0;
  }
}

float fastestFace(const MacVelocity& velocity, const Eigen::Vector3i& c) {
  float fastest = 0;
  for (int a = 0; a < 3; ++a)
    for (const int side : {0, 1})
      fastest = larger(fastest, std::abs(velocity[a](c + side * Eigen::Vector3i::Unit(a))));
  return fastest;
}

}  // namespace

Crowding::Crowding(const GridSpec& grid)
    : grid_(grid),
      divergence_(grid.cells),
      slabs_(grid.cells.x()),
      blocks_((grid.cells.array() + kBlock - 1) / kBlock) {}

void Crowding::prepare(const DenseField<float>& phi, const SolidBoundary& solids,
                       const MacVelocity& velocity) {
  forEachRow(grid_.cells, [&](int i, int j) {
    divergenceOfAirRow(&phi(i, j, 0), &solids.cellFraction(i, j, 0), FaceRows(solids.open, i, j),
                       FaceRows(solids.velocity, i, j), FaceRows(velocity, i, j), grid_.cells.z(),
                       &divergence_(i, j, 0));
  });
}

/// Density of what has come to the middle of a cell, less that of the liquid and relative to it, on a way
/// that is about `way` cells long.
float Crowding::compression(const MacVelocity& velocity, float cellsPerSpeed, const Eigen::Vector3i& cell,
                            float way) const {
  const MacView wind(velocity);
  const Eigen::Vector3f top = grid_.cells.cast<float>() - Eigen::Vector3f::Constant(kInside);
  const auto back = [&](const Eigen::Vector3f& from, float step, const Eigen::Vector3f& at) {
    const Velocity3f u = sampleInnerVelocity(wind, at.x(), at.y(), at.z());
    return Eigen::Vector3f(keptInside(from.x() - step * u.x, top.x()),
                           keptInside(from.y() - step * u.y, top.y()),
                           keptInside(from.z() - step * u.z, top.z()));
  };
  const int steps = std::max(kLeastSteps, static_cast<int>(std::ceil(kStepsPerCell * way)));
  const float step = cellsPerSpeed / static_cast<float>(steps);
  Eigen::Vector3f x = cell.cast<float>() + Eigen::Vector3f::Constant(0.5f);
  float sum = 0;
  for (int n = 0; n < steps; ++n) {
    const Eigen::Vector3f middle = back(x, 0.5f * step, x);
    sum += divergence_(middle.cast<int>());
    x = back(x, step, middle);
  }
  return std::clamp(std::exp(-sum * step), kThinnest, kDensest) - 1;
}

/// Liquid of a cell that phi does not show [dx^3].
float Crowding::crowdedIn(const Eigen::Vector3i& c, const DenseField<float>& phi, const SolidBoundary& solids,
                          const MacVelocity& velocity, float cellsPerSpeed) const {
  const float dx = static_cast<float>(grid_.dx), value = phi(c), room = solids.cellFraction(c);
  if (value >= kDryest * dx || value <= -kDeepest * dx || room <= 0) return 0;
  const float way = cellsPerSpeed * fastestFace(velocity, c);
  if (value < -(kStretch * way + kMargin) * dx) return 0;  // has always been in the liquid
  const float denser = compression(velocity, cellsPerSpeed, c, way);
  if (std::abs(denser) < kNoChange) return 0;
  return denser * room * liquidFractionOfCell(phi, dx, c.x(), c.y(), c.z());
}

void Crowding::find(const DenseField<float>& phi, const SolidBoundary& solids, const MacVelocity& velocity,
                    double dt) {
  const float cellsPerSpeed = static_cast<float>(dt / grid_.dx);
  tbb::parallel_for(0, grid_.cells.x(), [&](int i) {
    slabs_[i].clear();
    for (int j = 0; j < grid_.cells.y(); ++j)
      for (int k = 0; k < grid_.cells.z(); ++k) {
        const float volume = crowdedIn({i, j, k}, phi, solids, velocity, cellsPerSpeed);
        if (volume != 0) slabs_[i].push_back({{i, j, k}, volume});
      }
  });
  crowded_.clear();
  for (const auto& slab : slabs_) crowded_.insert(crowded_.end(), slab.begin(), slab.end());
}

double Crowding::excess() {
  for (const CrowdedCell& c : crowded_) blocks_(c.cell / kBlock) += c.volume;
  double sum = 0;
  for (const CrowdedCell& c : crowded_) {
    float& volume = blocks_(c.cell / kBlock);
    if (volume > kTaken) sum += volume - kTaken;
    volume = 0;
  }
  return sum;
}

}  // namespace spume::fluid
