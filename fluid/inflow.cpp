#include "fluid/inflow.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "fluid/counter_random.h"
#include "fluid/cut_fractions.h"
#include "fluid/errors.h"
#include "fluid/level_set.h"

namespace spume::fluid {
namespace {

// Faces are tested this far upstream [dx], so that an outlet flush with the grid is not decided by round-off.
constexpr double kUpstream = 0.25;
// Coverage is measured on this many squares a side of each face: the disc of an outlet to about 1/100 of a
// face.
constexpr int kSquares = 4;
// Tangential faces are closed if at least this fraction of them lies inside [-].
constexpr float kTangentialCoverage = 0.5f;
// Distance to which a region lowers phi around itself [dx]: as far as reinitialisation and markers look.
constexpr double kStampBand = 6;
// Plane waves that make up the fluctuation of an outlet's speed, and the purpose that keys their random
// numbers.
constexpr int kWaves = 6;
constexpr std::uint64_t kWavePurpose = 0x696e666c6f77;

/// Face centre moved upstream, or on the edge of the grid into it: a nozzle that reaches the edge is fed
/// through it.
Eigen::Vector3d probe(const GridSpec& grid, const Inflow& inflow, int axis, const Eigen::Vector3i& c) {
  const double shift = kUpstream * grid.dx;
  const Eigen::Vector3d centre = grid.faceCentre(axis, c.x(), c.y(), c.z());
  if (c[axis] == 0) return centre + shift * Eigen::Vector3d::Unit(axis);
  if (c[axis] == grid.cells[axis]) return centre - shift * Eigen::Vector3d::Unit(axis);
  return centre - shift * inflow.velocity.normalized();
}

double faceCoverage(const GridSpec& grid, const Inflow& inflow, int axis, const Eigen::Vector3i& c) {
  const Eigen::Vector3d centre = probe(grid, inflow, axis, c);
  const double middle = inflow.sdf(centre);
  if (std::abs(middle) > 1.5 * grid.dx) return middle < 0 ? 1 : 0;
  const Eigen::Vector3d u = grid.dx * Eigen::Vector3d::Unit((axis + 1) % 3);
  const Eigen::Vector3d v = grid.dx * Eigen::Vector3d::Unit((axis + 2) % 3);
  double inside[kSquares + 1][kSquares + 1], sum = 0;
  for (int p = 0; p <= kSquares; ++p)
    for (int q = 0; q <= kSquares; ++q)
      inside[p][q] =
          -inflow.sdf(centre + (p / double(kSquares) - 0.5) * u + (q / double(kSquares) - 0.5) * v);
  for (int p = 0; p < kSquares; ++p)
    for (int q = 0; q < kSquares; ++q)
      sum += squareFraction({inside[p][q], inside[p + 1][q], inside[p + 1][q + 1], inside[p][q + 1]});
  return sum / (kSquares * kSquares);
}

void validate(const Inflow& inflow) {
  const auto reject = [&](const std::string& what) {
    throw InvalidParameter("inflow \"" + inflow.name + "\": " + what);
  };
  if (!inflow.sdf) reject("has no region");
  if (!(inflow.velocity.norm() > 0) || !inflow.velocity.allFinite())
    reject("its velocity must be finite and not 0; close it by its scale instead");
  if (!(inflow.area > 0)) reject("the area of its outlet must be > 0 m^2");
  if (!(inflow.turbulence >= 0 && inflow.turbulence <= 0.5)) reject("turbulence must be 0 to 0.5");
}

/// Liquid in the given cells, in units of dx^3.
double liquidIn(const std::vector<Eigen::Vector3i>& cells, double dx, const DenseField<float>& phi,
                const SolidBoundary& boundary) {
  double sum = 0;
  for (const Eigen::Vector3i& c : cells)
    sum += liquidFractionOfCell(phi, static_cast<float>(dx), c.x(), c.y(), c.z()) * boundary.cellFraction(c);
  return sum;
}

}  // namespace

InflowSet::InflowSet(const GridSpec& grid, std::vector<Inflow> inflows, std::uint64_t seed)
    : grid_(grid), inflows_(std::move(inflows)), balance_(grid.cells, 0.0f), seed_(seed) {
  for (const Inflow& inflow : inflows_) {
    validate(inflow);
    nozzles_.push_back(rasterise(inflow));
    if (nozzles_.back().faces.empty())
      throw InvalidParameter("inflow \"" + inflow.name +
                             "\": its region covers no cell face; make it larger or dx smaller");
  }
}

InflowSet::Nozzle InflowSet::rasterise(const Inflow& inflow) const {
  Nozzle nozzle;
  double least = kStampBand * grid_.dx;
  const Eigen::Vector3i n = grid_.cells;
  for (int i = 0; i <= n.x(); ++i)
    for (int j = 0; j <= n.y(); ++j)
      for (int k = 0; k <= n.z(); ++k) {
        const Eigen::Vector3i c(i, j, k);
        const double sdf = inflow.sdf(grid_.cellCentre(i, j, k));
        if (sdf > kStampBand * grid_.dx) continue;
        const bool isCell = i < n.x() && j < n.y() && k < n.z();
        if (isCell) nozzle.cells.push_back({c, static_cast<float>(sdf)});
        if (isCell && sdf < grid_.dx) nozzle.touched.push_back(c);
        if (isCell && sdf < least) least = sdf, nozzle.deepest = c;
        for (int a = 0; a < 3; ++a) addFace(inflow, a, c, nozzle);
      }
  return nozzle;
}

void InflowSet::addFace(const Inflow& inflow, int axis, const Eigen::Vector3i& c, Nozzle& nozzle) const {
  const Eigen::Vector3i extent = grid_.cells + Eigen::Vector3i::Unit(axis);
  if ((c.array() >= extent.array()).any()) return;
  const auto coverage = static_cast<float>(faceCoverage(grid_, inflow, axis, c));
  const bool tangential = inflow.velocity[axis] == 0;
  if (coverage < (tangential ? kTangentialCoverage : kMinOpenFraction)) return;
  nozzle.faces.push_back({axis, c, coverage});
}

double InflowSet::scaleAt(const Inflow& inflow, double t) const { return inflow.scale ? inflow.scale(t) : 1; }

double InflowSet::flux(std::size_t n, double t) const {
  return inflows_[n].velocity.norm() * inflows_[n].area * scaleAt(inflows_[n], t);
}

/// Relative fluctuation of the speed: plane waves across the jet, about as long as the outlet is wide, that
/// turn over in the time the jet moves by its own width; unit mean square. Constant along the velocity.
double InflowSet::fluctuation(std::size_t n, double t, const Eigen::Vector3d& x) const {
  const Inflow& inflow = inflows_[n];
  const double radius = std::sqrt(inflow.area / std::numbers::pi), speed = inflow.velocity.norm();
  const Eigen::Vector3d axis = inflow.velocity / speed, side = axis.unitOrthogonal(), up = axis.cross(side);
  double sum = 0;
  for (int wave = 0; wave < kWaves; ++wave) {
    CounterRandom random(seed_, n * kWaves + wave, kWavePurpose);
    const double angle = 2 * std::numbers::pi * random.uniform(),
                 phase = 2 * std::numbers::pi * random.uniform();
    const double number = (1 + 2 * random.uniform()) / radius,
                 frequency = (1 + random.uniform()) * speed / radius;
    sum += std::cos(number * (std::cos(angle) * x.dot(side) + std::sin(angle) * x.dot(up)) + frequency * t +
                    phase);
  }
  return sum * std::sqrt(2.0 / kWaves);
}

/// Velocities of the jet on the nozzle's faces, normalised to the exact flux, and the sources at its back.
void InflowSet::setSpeed(std::size_t n, double t, SolidBoundary& boundary) {
  const Inflow& inflow = inflows_[n];
  Nozzle& nozzle = nozzles_[n];
  const auto eachSide = [](const Face& face,
                           const auto& body) {  // outflow of the lower cell, inflow of the upper
    const float flow = face.coverage * face.savedOpen * face.velocity;
    body(face.cell - Eigen::Vector3i::Unit(face.axis), flow);
    body(face.cell, -flow);
  };
  for (Face& face : nozzle.faces) {
    const Eigen::Vector3i& c = face.cell;
    double speed = inflow.velocity[face.axis] * scaleAt(inflow, t);
    if (inflow.turbulence > 0)
      speed *= 1 + inflow.turbulence * fluctuation(n, t, grid_.faceCentre(face.axis, c.x(), c.y(), c.z()));
    face.velocity = static_cast<float>(speed);
    eachSide(face, [&](const Eigen::Vector3i& cell, float outflow) { balance_(cell) += outflow; });
  }
  double filled = 0;
  nozzle.sources.clear();
  const auto settle = [&](const Eigen::Vector3i& cell, float) {
    const float outflow = std::exchange(balance_(cell), 0);
    if (!balance_.contains(cell.x(), cell.y(), cell.z())) return;
    if (!boundary.hasOpenFace(cell.x(), cell.y(), cell.z())) return;  // inside the nozzle
    if (outflow < 0) filled -= outflow;
    if (outflow > 0) nozzle.sources.push_back({cell, outflow});
  };
  for (const Face& face : nozzle.faces) eachSide(face, settle);
  const double factor = filled > 0 ? flux(n, t) / (filled * grid_.dx * grid_.dx) : 0;
  for (Source& source : nozzle.sources) source.rate = static_cast<float>(factor * source.rate / grid_.dx);
  for (Face& face : nozzle.faces) {
    face.velocity = static_cast<float>(factor * face.velocity);
    boundary.velocity[face.axis](face.cell) =
        face.savedOpen * face.coverage * face.velocity + (1 - face.savedOpen) * face.savedVelocity;
  }
}

void InflowSet::release(Nozzle& nozzle, SolidBoundary& boundary) const {
  for (auto face = nozzle.faces.rbegin(); face != nozzle.faces.rend(); ++face) {
    if (!nozzle.open || !boundary.prescribed[face->axis](face->cell))
      continue;  // rewritten by a moving solid
    boundary.prescribed[face->axis](face->cell) = 0;
    boundary.open[face->axis](face->cell) = face->savedOpen;
    boundary.velocity[face->axis](face->cell) = face->savedVelocity;
  }
  nozzle.open = false;
}

void InflowSet::close(Nozzle& nozzle, SolidBoundary& boundary) const {
  for (Face& face : nozzle.faces) {
    float& open = boundary.open[face.axis](face.cell);
    face.savedOpen = open;
    face.savedVelocity = boundary.velocity[face.axis](face.cell);
    open = 0;
    boundary.prescribed[face.axis](face.cell) = 1;
  }
  nozzle.open = true;
}

void InflowSet::release(SolidBoundary& boundary) {
  for (auto nozzle = nozzles_.rbegin(); nozzle != nozzles_.rend(); ++nozzle) release(*nozzle, boundary);
}

void InflowSet::resume(double t, SolidBoundary& boundary) {
  for (std::size_t n = 0; n < inflows_.size(); ++n)
    if (scaleAt(inflows_[n], t) > 0) close(nozzles_[n], boundary), setSpeed(n, t, boundary);
}

const std::vector<PouredVolume>& InflowSet::stamp(double t, double dt, DenseField<float>& phi,
                                                  SolidBoundary& boundary) {
  poured_.clear();
  reshaped_ = false;
  for (std::size_t n = 0; n < inflows_.size(); ++n)
    reshaped_ |= nozzles_[n].open != (scaleAt(inflows_[n], t) > 0);
  release(boundary);
  for (std::size_t n = 0; n < inflows_.size(); ++n) {
    Nozzle& nozzle = nozzles_[n];
    if (!(scaleAt(inflows_[n], t) > 0)) continue;
    const bool opens = t - dt <= 0 || !(scaleAt(inflows_[n], t - dt) > 0);
    const double before = opens ? liquidIn(nozzle.touched, grid_.dx, phi, boundary) : 0;
    for (const Cell& cell : nozzle.cells) {
      float& level = phi(cell.cell);
      reshaped_ |= level >= 0 && cell.sdf < 0;
      level = std::min(level, cell.sdf);
    }
    const double filling = opens ? liquidIn(nozzle.touched, grid_.dx, phi, boundary) - before : 0;
    poured_.push_back({flux(n, t) * dt + filling * grid_.cellVolume(), nozzle.deepest});
    close(nozzle, boundary);
    setSpeed(n, t, boundary);
  }
  return poured_;
}

void InflowSet::setVelocity(MacVelocity& velocity) const {
  for (const Nozzle& nozzle : nozzles_)
    if (nozzle.open)
      for (const Face& face : nozzle.faces) velocity[face.axis](face.cell) = face.velocity;
}

void InflowSet::addSource(DenseField<float>& divergenceSource) const {
  for (const Nozzle& nozzle : nozzles_)
    if (nozzle.open)
      for (const Source& source : nozzle.sources) divergenceSource(source.cell) += source.rate;
}

}  // namespace spume::fluid
