#include "coupling/still_liquid.h"

#include <algorithm>
#include <limits>

#include "coupling/domain_box.h"
#include "coupling/shapes.h"
#include "foam/parallel.h"

namespace spume::coupling {
namespace {

constexpr double kDifference = 1e-6;  // [m] of central differences: 1e-10 of round-off, no bend in between

foam::StillPoolParams poolOf(const Scene& scene) {
  foam::StillPoolParams pool;
  pool.gravity = scene.liquid.gravity;
  pool.density = scene.liquid.density;
  pool.surfaceHeight = scene.stillPool.level;
  const DomainBox domain(scene);
  pool.lower = domain.lower;
  pool.upper = domain.upper;
  pool.closed = scene.domain.closed;
  return pool;
}

Eigen::Vector3d slopeOf(const SignedDistance& distance, const Eigen::Vector3d& x) {
  Eigen::Vector3d slope;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d step = kDifference * Eigen::Vector3d::Unit(axis);
    slope[axis] = (distance(x + step) - distance(x - step)) / (2 * kDifference);
  }
  return slope;
}

template <typename Body>
void forEachPoint(foam::Points x, const Body& body) {
  foam::forEachIndex(static_cast<std::size_t>(x.cols()),
                     [&](std::size_t i) { body(static_cast<Eigen::Index>(i)); });
}

/// phi at the centres of the cells.
fluid::DenseField<float> phiOnGrid(const fluid::GridSpec& grid, const PoolSampler& sampler) {
  fluid::DenseField<float> phi(grid.cells);
  Eigen::Matrix3Xd column(3, grid.cells.z());
  Eigen::VectorXd value(grid.cells.z());
  for (int i = 0; i < grid.cells.x(); ++i)
    for (int j = 0; j < grid.cells.y(); ++j) {
      for (int k = 0; k < grid.cells.z(); ++k) column.col(k) = grid.cellCentre(i, j, k);
      sampler.phi(column, value);
      for (int k = 0; k < grid.cells.z(); ++k) phi(i, j, k) = static_cast<float>(value[k]);
    }
  return phi;
}

/// Volume under the surface and outside the solids; a cell is wet by the share its phi says.
double wetVolume(const fluid::GridSpec& grid, const fluid::DenseField<float>& phi,
                 const fluid::SolidBoundary& solids) {
  double cells = 0;
  for (int i = 0; i < grid.cells.x(); ++i)
    for (int j = 0; j < grid.cells.y(); ++j)
      for (int k = 0; k < grid.cells.z(); ++k)
        cells += std::clamp(0.5 - phi(i, j, k) / grid.dx, 0.0, 1.0) * solids.cellFraction(i, j, k);
  return cells * grid.cellVolume();
}

}  // namespace

PoolSampler::PoolSampler(const Scene& scene) : pool_(poolOf(scene)), solids_(solidDistances(scene)) {
  if (!scene.liquidBodies.empty()) bodies_ = initialPhi(scene);
}

double PoolSampler::bodyPhi(const Eigen::Vector3d& x) const {
  return bodies_ ? bodies_(x) - kBodyMargin : -std::numeric_limits<double>::infinity();
}

PoolSampler::Nearest PoolSampler::nearest(const Eigen::Vector3d& x, double wall) const {
  Nearest found{wall, -1};
  for (std::size_t s = 0; s < solids_.size(); ++s)
    if (const double distance = solids_[s](x); distance < found.distance)
      found = {distance, static_cast<int>(s)};
  return found;
}

void PoolSampler::phi(foam::Points x, foam::Scalars out) const {
  pool_.phi(x, out);
  if (bodies_) forEachPoint(x, [&](Eigen::Index i) { out[i] = std::max(out[i], bodyPhi(x.col(i))); });
}

void PoolSampler::gradPhi(foam::Points x, foam::Vectors out) const {
  pool_.gradPhi(x, out);
  if (!bodies_) return;
  Eigen::VectorXd plane(x.cols());
  pool_.phi(x, plane);
  forEachPoint(x, [&](Eigen::Index i) {
    if (bodyPhi(x.col(i)) > plane[i]) out.col(i) = slopeOf(bodies_, x.col(i));
  });
}

void PoolSampler::velocity(foam::Points x, foam::Vectors out) const { pool_.velocity(x, out); }

void PoolSampler::gradPressure(foam::Points x, foam::Vectors out) const { pool_.gradPressure(x, out); }

void PoolSampler::psi(foam::Points x, foam::Scalars out) const {
  pool_.psi(x, out);
  if (!solids_.empty()) forEachPoint(x, [&](Eigen::Index i) { out[i] = nearest(x.col(i), out[i]).distance; });
}

void PoolSampler::gradPsi(foam::Points x, foam::Vectors out) const {
  pool_.gradPsi(x, out);
  if (solids_.empty()) return;
  Eigen::VectorXd wall(x.cols());
  pool_.psi(x, wall);
  forEachPoint(x, [&](Eigen::Index i) {
    const int solid = nearest(x.col(i), wall[i]).solid;
    if (solid >= 0) out.col(i) = slopeOf(solids_[solid], x.col(i));
  });
}

void PoolSampler::solidVelocity(foam::Points, foam::Vectors out) const { out.setZero(); }

void PoolSampler::solidIndex(foam::Points x, foam::Indices out) const {
  Eigen::VectorXd wall(x.cols());
  pool_.psi(x, wall);
  forEachPoint(x, [&](Eigen::Index i) { out[i] = nearest(x.col(i), wall[i]).solid; });
}

StillLiquid::StillLiquid(const Scene& scene, double time) : sampler_(scene) {
  const fluid::LiquidSetup setup = buildLiquidSetup(scene);
  solids_ = fluid::buildSolidBoundary(setup.grid, setup.walls, setup.solids, 0);
  state_.grid = setup.grid;
  state_.time = before_ = time;
  state_.phi = phiOnGrid(setup.grid, sampler_);
  state_.velocity = fluid::MacVelocity(setup.grid.cells);
  state_.pressureGradient = fluid::MacField<float>(setup.grid.cells);
  pressure_ = fluid::DenseField<float>(setup.grid.cells);
  fillPressure(scene);
  volume_ = wetVolume(setup.grid, state_.phi, solids_);
}

/// Hydrostatic; phi is the depth.
void StillLiquid::fillPressure(const Scene& scene) {
  const Eigen::Vector3d weight = scene.liquid.density * scene.liquid.gravity;
  for (int axis = 0; axis < 3; ++axis) state_.pressureGradient[axis].fill(static_cast<float>(weight[axis]));
  const Eigen::Vector3i& cells = state_.grid.cells;
  for (int i = 0; i < cells.x(); ++i)
    for (int j = 0; j < cells.y(); ++j)
      for (int k = 0; k < cells.z(); ++k)
        pressure_(i, j, k) = static_cast<float>(weight.norm()) * std::max(0.0f, -state_.phi(i, j, k));
}

fluid::LiquidStepReport StillLiquid::step(double dt, const fluid::ImmersedGas&,
                                          const std::vector<fluid::Push>&) {
  before_ = state_.time;
  state_.time += dt;
  fluid::LiquidStepReport report;
  report.liquidVolume = report.targetVolume = volume_;
  return report;
}

void StillLiquid::rollBack() { state_.time = before_; }

double StillLiquid::stableDt(int) const { return std::numeric_limits<double>::infinity(); }

std::unique_ptr<foam::LiquidSampler> StillLiquid::sampler() const {
  return std::make_unique<PoolSampler>(sampler_);
}

}  // namespace spume::coupling
