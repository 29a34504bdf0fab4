#include "coupling/probes.h"

#include <algorithm>
#include <cmath>

#include "coupling/scene_builder.h"
#include "coupling/shapes.h"
#include "coupling/trilinear.h"
#include "coupling/vdb_liquid_sampler.h"
#include "fluid/level_set.h"
#include "fluid/plane_fraction.h"

namespace spume::coupling {
namespace {

constexpr double kGaugeStep = 0.25;  // [dx] between the points of a gauge; crossings are linear between them

Eigen::Vector3d upwards(const Scene& scene) {
  const Eigen::Vector3d& gravity = scene.liquid.gravity;
  return gravity.norm() > 0 ? Eigen::Vector3d(-gravity.normalized()) : Eigen::Vector3d(0, 1, 0);
}

/// A cell of a region and the part of it inside.
struct Share {
  Eigen::Vector3i cell;
  double part;
};

/// Part of a cell in the region, its border taken as a plane: exact for a box away from its edges.
double partInside(const ShapeSpec& region, const fluid::GridSpec& grid, const Eigen::Vector3d& centre) {
  const double value = signedDistance(region, centre);
  if (std::abs(value) > grid.dx) return value < 0 ? 1 : 0;
  Eigen::Vector3d rise;
  for (int a = 0; a < 3; ++a) {
    const Eigen::Vector3d half = 0.5 * grid.dx * Eigen::Vector3d::Unit(a);
    rise[a] = signedDistance(region, centre + half) - signedDistance(region, centre - half);
  }
  return fluid::planeFraction(value, rise.x(), rise.y(), rise.z());
}

std::vector<Share> sharesOf(const ShapeSpec& region, const fluid::GridSpec& grid) {
  std::vector<Share> shares;
  for (int i = 0; i < grid.cells.x(); ++i)
    for (int j = 0; j < grid.cells.y(); ++j)
      for (int k = 0; k < grid.cells.z(); ++k) {
        const double part = partInside(region, grid, grid.cellCentre(i, j, k));
        if (part > 0) shares.push_back({{i, j, k}, part});
      }
  return shares;
}

foam::Points onePoint(const Eigen::Vector3d& x) { return Eigen::Map<const Eigen::Matrix3Xd>(x.data(), 3, 1); }

std::string nameOf(const Scene& scene, std::size_t probe) {
  const std::string& name = scene.probes[probe].name;
  return name.empty() ? "probe" + std::to_string(probe) : name;
}

}  // namespace

struct Probes::Internals {
  std::vector<ProbeSpec> probes;
  std::vector<std::vector<Share>> regions;  // of each probe; empty but for volumes
  Eigen::Vector3d up;
  double topmost;  // longest gauge [m]

  void readGauge(const ProbeSpec& probe, const VdbLiquidSampler& fields, double dx,
                 std::vector<double>& out) const;
  double readPressure(const Eigen::Vector3d& x, const LiquidPart& liquid) const;
  double readVolume(const std::vector<Share>& region, const LiquidPart& liquid) const;
};

/// Walks up from the foot; what lies in a solid counts as air.
void Probes::Internals::readGauge(const ProbeSpec& probe, const VdbLiquidSampler& fields, double dx,
                                  std::vector<double>& out) const {
  const int steps = static_cast<int>(std::ceil(topmost / (kGaugeStep * dx)));
  const double step = topmost / steps;
  Eigen::Matrix3Xd points(3, steps + 1);
  for (int n = 0; n <= steps; ++n) points.col(n) = probe.position + n * step * up;
  Eigen::VectorXd phi(steps + 1), psi(steps + 1);
  fields.phi(points, phi);
  fields.psi(points, psi);
  for (int n = 0; n <= steps; ++n) phi[n] = std::max(phi[n], -psi[n]);
  double surface = 0, wet = 0;
  for (int n = 0; n < steps; ++n) {
    const double low = phi[n], high = phi[n + 1];
    if (low >= 0 && high >= 0) continue;
    const double crossing = low < 0 && high < 0 ? 1 : std::abs(low) / (std::abs(low) + std::abs(high));
    wet += step * (low < 0 ? crossing : 1 - crossing);
    surface = step * (n + (high < 0 ? 1 : crossing));
  }
  out.insert(out.end(), {surface, wet});
}

/// Mean, weighted trilinearly, of what the liquid cells around the point say by their pressure and its
/// gradient.
double Probes::Internals::readPressure(const Eigen::Vector3d& x, const LiquidPart& liquid) const {
  const fluid::LiquidState& state = liquid.state();
  const VdbLiquidSampler fields(state, liquid.solids());
  const TrilinearCell around =
      locate(state.grid.cells, Eigen::Vector3d::Constant(0.5), state.grid.toCells(x));
  double weight[8], sum = 0, known = 0;
  TrilinearCell between = around;
  for (double& along : between.along) along = std::clamp(along, 1e-3, 1 - 1e-3);  // every corner has a say
  trilinearWeights(between, weight);
  Eigen::Matrix3Xd gradients(3, 1);
  for (int n = 0; n < 8; ++n) {
    const Eigen::Vector3i c(around.corner[0] + (n >> 2), around.corner[1] + (n >> 1 & 1),
                            around.corner[2] + (n & 1));
    if (state.phi(c) >= 0 || !liquid.solids().hasOpenFace(c.x(), c.y(), c.z())) continue;
    const Eigen::Vector3d centre = state.grid.cellCentre(c.x(), c.y(), c.z());
    fields.gradPressure(onePoint(0.5 * (centre + x)), gradients);
    sum += weight[n] * (liquid.pressure()(c) + gradients.col(0).dot(x - centre));
    known += weight[n];
  }
  Eigen::VectorXd phi(1);
  fields.phi(onePoint(x), phi);
  return known > 0 && phi[0] < 0 ? sum / known : 0;
}

double Probes::Internals::readVolume(const std::vector<Share>& region, const LiquidPart& liquid) const {
  const fluid::LiquidState& state = liquid.state();
  fluid::DenseField<float> fraction(state.grid.cells);
  fluid::computeLiquidFraction(state.phi, liquid.solids(), static_cast<float>(state.grid.dx), fraction);
  double volume = 0;
  for (const auto& [cell, part] : region) volume += part * fraction(cell);
  return volume * state.grid.cellVolume();
}

std::vector<ColumnInfo> probeColumns(const Scene& scene) {
  std::vector<ColumnInfo> columns;
  for (std::size_t n = 0; n < scene.probes.size(); ++n) {
    const std::string name = nameOf(scene, n);
    switch (scene.probes[n].kind) {
      case ProbeKind::height:
        columns.push_back({name + "_surface", "m", "topmost surface over the gauge's foot"});
        columns.push_back({name + "_wet", "m", "length of the gauge that is in liquid"});
        break;
      case ProbeKind::pressure:
        columns.push_back({name, "Pa", "over that of the air"});
        break;
      case ProbeKind::velocity:
        for (const char* axis : {"_x", "_y", "_z"}) columns.push_back({name + axis, "m/s", "of the liquid"});
        break;
      case ProbeKind::volume:
        columns.push_back({name, "m^3", "of liquid in the region"});
        break;
    }
  }
  return columns;
}

Probes::Probes(const Scene& scene) {
  auto internals = std::make_unique<Internals>();
  internals->probes = scene.probes;
  internals->up = upwards(scene);
  const fluid::GridSpec grid = gridOf(scene);
  internals->topmost = (grid.upper() - grid.origin).cwiseProduct(internals->up).cwiseAbs().sum();
  for (const ProbeSpec& probe : scene.probes)
    internals->regions.push_back(probe.kind == ProbeKind::volume ? sharesOf(probe.shape, grid)
                                                                 : std::vector<Share>());
  internals_ = std::move(internals);
}

Probes::~Probes() = default;
Probes::Probes(Probes&&) noexcept = default;

std::vector<double> Probes::read(const LiquidPart& liquid) const {
  std::vector<double> values;
  const VdbLiquidSampler fields(liquid.state(), liquid.solids());
  for (std::size_t n = 0; n < internals_->probes.size(); ++n) {
    const ProbeSpec& probe = internals_->probes[n];
    Eigen::Matrix3Xd velocity(3, 1);
    switch (probe.kind) {
      case ProbeKind::height:
        internals_->readGauge(probe, fields, liquid.state().grid.dx, values);
        break;
      case ProbeKind::pressure:
        values.push_back(internals_->readPressure(probe.position, liquid));
        break;
      case ProbeKind::velocity:
        fields.velocity(onePoint(probe.position), velocity);
        values.insert(values.end(), velocity.data(), velocity.data() + 3);
        break;
      case ProbeKind::volume:
        values.push_back(internals_->readVolume(internals_->regions[n], liquid));
        break;
    }
  }
  return values;
}

}  // namespace spume::coupling
