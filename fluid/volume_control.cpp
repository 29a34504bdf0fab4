#include "fluid/volume_control.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "fluid/errors.h"
#include "fluid/level_set.h"
#include "fluid/liquid_solver.h"
#include "fluid/parallel.h"

namespace spume::fluid {
namespace {

// Relative volume error below which a body is left alone: what float phi cannot resolve would otherwise keep
// a still pool moving. At 2e-9 and the default relaxation time a pool 4 cm deep would move at 8e-9 m/s.
constexpr double kVolumeDeadband = 2e-9;
// Largest error acted on, relative to the body's room: a drop of a few cells whose measured volume is mostly
// noise grows or shrinks by no more than e^(1/2) per relaxation time.
constexpr double kLargestError = 0.5;
// How far from its place a lost body's heir, or a bubble's liquid, is looked for [cells].
constexpr int kNearby = 4;

/// True if a straight way of open faces joins two cells, or no thin wall is near the first.
bool seesCell(const SolidBoundary* solids, const Eigen::Vector3i& from, const Eigen::Vector3i& to) {
  if (!solids || !(solids->sides.guard(from) & WallSides::kInReach)) return true;
  const auto middle = [](const Eigen::Vector3i& c) -> Eigen::Vector3f {
    return c.cast<float>() + Eigen::Vector3f::Constant(0.5f);
  };
  return walkThroughFaces(*solids, from, middle(from), middle(to)).cell == to;
}

/// Label with the largest volume within `reach` cells of a point, on its side of thin walls, else -1.
/// `largest` is the largest body of all: it ends the search.
std::int32_t largestNear(const GridSpec& grid, const SolidBoundary* solids,
                         const DenseField<std::int32_t>& label, const std::vector<LiquidBody>& bodies,
                         const Eigen::Vector3d& x, int reach, std::int32_t largest) {
  const Eigen::Vector3i centre = grid.toCells(x).array().floor().cast<int>();
  const Eigen::Vector3i low = (centre.array() - reach).max(0);
  const Eigen::Vector3i high = (centre.array() + reach).min(grid.cells.array() - 1);
  std::int32_t best = -1;
  for (int i = low.x(); i <= high.x(); ++i)
    for (int j = low.y(); j <= high.y(); ++j)
      for (int k = low.z(); k <= high.z(); ++k) {
        const std::int32_t n = label(i, j, k);
        if (n < 0 || n == best || (best >= 0 && bodies[n].volume <= bodies[best].volume)) continue;
        if (seesCell(solids, centre.cwiseMax(low).cwiseMin(high), {i, j, k})) best = n;
        if (best == largest) return best;
      }
  return best;
}

std::int32_t largest(const std::vector<LiquidBody>& bodies) {
  if (bodies.empty()) return -1;
  const auto body =
      std::max_element(bodies.begin(), bodies.end(),
                       [](const LiquidBody& a, const LiquidBody& b) { return a.volume < b.volume; });
  return static_cast<std::int32_t>(body - bodies.begin());
}

}  // namespace

VolumeControl::VolumeControl(const GridSpec& grid, const FluidParams& params, const SolidBoundary* solids)
    : grid_(grid),
      solids_(solids),
      relaxationTime_(params.volumeControlTime),
      lastLabel_(grid.cells, -1),
      links_(grid.cells.x()) {}

void VolumeControl::start(const LiquidBodies& bodies) {
  VolumeLedger ledger;
  for (const LiquidBody& body : bodies.bodies) ledger.target.push_back(body.volume);
  resume(bodies, std::move(ledger));
}

void VolumeControl::resume(const LiquidBodies& bodies, VolumeLedger ledger) {
  if (ledger.target.size() != bodies.bodies.size())
    throw InvalidParameter("volume ledger of " + std::to_string(ledger.target.size()) +
                           " bodies for a liquid of " + std::to_string(bodies.bodies.size()) +
                           ": it belongs to another state");
  ledger_ = std::move(ledger);
  ledger_.loss.resize(bodies.bodies.size(), 0);
  gas_.assign(bodies.bodies.size(), 0);
  lastLabel_ = bodies.label;
  lastBodies_ = bodies.bodies;
  lastLargest_ = largest(lastBodies_);
}

double VolumeControl::bookOutflow(const DenseField<float>& phi, const SolidBoundary& boundary,
                                  const MacVelocity& velocity, double dt) {
  double drained = 0;
  const double share = dt * grid_.dx * grid_.dx;
  const auto bookFace = [&](int axis, int side, const Eigen::Vector3i& c) {
    const Eigen::Vector3i face = side > 0 ? c + Eigen::Vector3i::Unit(axis) : c;
    const std::int32_t body = lastLabel_(c);
    const double speed = side * boundary.open[axis](face) * velocity[axis](face);
    if (body < 0 || !(speed > 0)) return;
    const double out = std::min(
        ledger_.target[body],
        share * speed * liquidFractionOfCell(phi, static_cast<float>(grid_.dx), c.x(), c.y(), c.z()));
    ledger_.target[body] -= out;
    drained += out;
  };
  for (int a = 0; a < 3; ++a)
    for (int side : {-1, 1}) {
      if (boundary.walls.closed[2 * a + (side > 0)]) continue;
      const int b = (a + 1) % 3, d = (a + 2) % 3;
      Eigen::Vector3i c;
      c[a] = side > 0 ? grid_.cells[a] - 1 : 0;
      for (c[b] = 0; c[b] < grid_.cells[b]; ++c[b])
        for (c[d] = 0; c[d] < grid_.cells[d]; ++c[d]) bookFace(a, side, c);
    }
  return drained;
}

double VolumeControl::take(std::int32_t body, double volume) {
  double& target = body >= 0 ? ledger_.target[body] : ledger_.unassigned;
  const double taken = std::clamp(volume, 0.0, std::max(0.0, target));
  target -= taken;
  return taken;
}

double VolumeControl::bookDrained(const Eigen::Vector3i& cell, double volume) {
  const std::int32_t own = lastLabel_(cell);
  return take(own >= 0 ? own : lastBodyNear(grid_.cellCentre(cell.x(), cell.y(), cell.z())), volume);
}

std::int32_t VolumeControl::lastBodyNear(const Eigen::Vector3d& x) const {
  const std::int32_t near = largestNear(grid_, solids_, lastLabel_, lastBodies_, x, kNearby, lastLargest_);
  return near >= 0 ? near : lastLargest_;
}

double VolumeControl::withdraw(const Eigen::Vector3d& x, double volume) {
  return take(lastBodyNear(x), volume);
}

void VolumeControl::deposit(const Eigen::Vector3d& x, double volume) {
  const std::int32_t body = lastBodyNear(x);
  (body >= 0 ? ledger_.target[body] : ledger_.unassigned) += volume;
}

/// Notes which old body each cell's liquid came from, as pairs (new, old) without repeats within a slab.
void VolumeControl::traceBack(const LiquidBodies& bodies, const MacVelocity& velocity, double dt) {
  const float steps = static_cast<float>(0.5 * dt / grid_.dx);
  const Eigen::Vector3i last = grid_.cells - Eigen::Vector3i::Ones();
  tbb::parallel_for(0, grid_.cells.x(), [&](int i) {
    std::vector<std::pair<std::int32_t, std::int32_t>>& links = links_[i];
    links.clear();
    for (int j = 0; j < grid_.cells.y(); ++j)
      for (int k = 0; k < grid_.cells.z(); ++k) {
        const std::int32_t body = bodies.label(i, j, k);
        if (body < 0) continue;
        const Eigen::Vector3f move(velocity[0](i, j, k) + velocity[0](i + 1, j, k),
                                   velocity[1](i, j, k) + velocity[1](i, j + 1, k),
                                   velocity[2](i, j, k) + velocity[2](i, j, k + 1));
        const Eigen::Vector3i from =
            Eigen::Vector3i(i, j, k) - (steps * move).array().round().matrix().cast<int>();
        const Eigen::Vector3i source = from.cwiseMax(0).cwiseMin(last);
        const std::int32_t old = lastLabel_(source);
        if (old < 0 || (!links.empty() && links.back() == std::pair(body, old))) continue;
        if (!seesCell(solids_, {i, j, k}, source)) continue;
        links.emplace_back(body, old);
      }
    std::sort(links.begin(), links.end());
    links.erase(std::unique(links.begin(), links.end()), links.end());
  });
}

std::int32_t VolumeControl::group(std::int32_t node) {
  while (group_[node] != node) node = group_[node] = group_[group_[node]];
  return node;
}

void VolumeControl::unite(std::int32_t a, std::int32_t b) {
  a = group(a);
  b = group(b);
  group_[std::max(a, b)] = std::min(a, b);
}

/// Groups the new bodies (nodes 0 ...) and the old ones (nodes after them) by exchange of cells. A body that
/// came or went without a trace joins the largest one nearby.
void VolumeControl::findGroups(const LiquidBodies& bodies) {
  const auto now = static_cast<std::int32_t>(bodies.bodies.size());
  const auto old = static_cast<std::int32_t>(lastBodies_.size());
  group_.resize(now + old);
  std::iota(group_.begin(), group_.end(), 0);
  const std::int32_t largestNow = largest(bodies.bodies);
  std::vector<char>& linked = linked_;
  linked.assign(now + old, 0);
  for (const auto& links : links_)
    for (const auto& [to, from] : links) {
      unite(to, now + from);
      linked[to] = linked[now + from] = 1;
    }
  for (std::int32_t n = 0; n < now + old; ++n) {
    if (linked[n]) continue;
    const bool isNew = n < now;
    const Eigen::Vector3d& place = isNew ? bodies.bodies[n].centroid : lastBodies_[n - now].centroid;
    std::int32_t heir =
        isNew ? largestNear(grid_, solids_, lastLabel_, lastBodies_, place, kNearby, lastLargest_)
              : largestNear(grid_, solids_, bodies.label, bodies.bodies, place, kNearby, largestNow);
    if (heir < 0) heir = isNew ? lastLargest_ : largestNow;
    if (heir >= 0) unite(n, isNew ? now + heir : heir);
  }
}

void VolumeControl::bookGas(const LiquidBodies& bodies, const ImmersedGas& gas) {
  gas_.assign(bodies.bodies.size(), 0);
  gasBody_.resize(gas.volume.size());
  const std::int32_t most = largest(bodies.bodies);
  tbb::parallel_for(std::size_t{0}, gas.volume.size(), [&](std::size_t b) {
    std::int32_t& body = gasBody_[b];
    body = -1;
    for (const int reach : {0, kNearby})
      if (body < 0)
        body = largestNear(grid_, solids_, bodies.label, bodies.bodies, gas.position[b], reach, most);
  });
  for (std::size_t b = 0; b < gas.volume.size(); ++b)
    if (gasBody_[b] >= 0) gas_[gasBody_[b]] += gas.volume[b];
}

void VolumeControl::update(const LiquidBodies& bodies, const MacVelocity& velocity, double dt,
                           const std::vector<PouredVolume>& poured, const ImmersedGas& gas) {
  const std::size_t now = bodies.bodies.size();
  traceBack(bodies, velocity, dt);
  findGroups(bodies);
  bookGas(bodies, gas);

  sums_.assign(group_.size(), GroupSum{});
  double homeless = ledger_.unassigned;
  for (std::size_t n = 0; n < now; ++n) {
    GroupSum& sum = sums_[group(n)];
    ++sum.bodies;
    sum.volume += bodies.bodies[n].volume;
    sum.liquid += bodies.bodies[n].volume - gas_[n];
    sum.room += bodies.bodies[n].room;
  }
  const auto give = [&](std::int32_t node, double target) {
    const bool hasHeir = node >= 0 && sums_[group(node)].bodies > 0;
    (hasHeir ? sums_[group(node)].target : homeless) += target;
  };
  for (std::size_t n = 0; n < lastBodies_.size(); ++n) {
    give(static_cast<std::int32_t>(now + n), ledger_.target[n]);
    sums_[group(static_cast<std::int32_t>(now + n))].loss += ledger_.loss[n];
  }
  for (const PouredVolume& pour : poured) give(bodies.label(pour.cell), pour.volume);
  const std::int32_t heir = largest(bodies.bodies);
  if (heir >= 0) give(heir, std::exchange(homeless, 0));
  ledger_.unassigned = homeless;
  dealTargets(bodies);
  lastLabel_ = bodies.label;
  lastBodies_ = bodies.bodies;
  lastLargest_ = largest(lastBodies_);
}

/// Within a group every body gets its own liquid and a share of the group's error in proportion to its
/// volume; of the group's loss, too.
void VolumeControl::dealTargets(const LiquidBodies& bodies) {
  ledger_.target.resize(bodies.bodies.size());
  ledger_.loss.resize(bodies.bodies.size());
  for (std::size_t n = 0; n < bodies.bodies.size(); ++n) {
    const GroupSum& sum = sums_[group(static_cast<std::int32_t>(n))];
    const LiquidBody& body = bodies.bodies[n];
    const double share = sum.volume > 0 ? body.volume / sum.volume : body.room / sum.room;
    ledger_.target[n] =
        sum.bodies == 1 ? sum.target : body.volume - gas_[n] + share * (sum.target - sum.liquid);
    ledger_.loss[n] = sum.bodies == 1 ? sum.loss : share * sum.loss;
  }
}

/// Divergence [1/s] that body n is given; its loss learns from the error. With x = 1 - e^(-dt/tau) of the
/// error acted on per sub-step, x^2/4 of it to learn from makes both fade alike, without ringing.
double VolumeControl::rateOf(const LiquidBody& body, std::size_t n, double dt) {
  double& loss = ledger_.loss[n];
  if (!body.touchesAir) return loss = 0;
  const double share = -std::expm1(-dt / relaxationTime_), limit = kLargestError * body.room;
  const double deadband = kVolumeDeadband * body.volume;
  const double error = ledger_.target[n] + gas_[n] - body.volume;
  const bool still = std::abs(error) <= deadband;
  const double acted = still ? 0 : std::clamp(error, -limit, limit);
  const double created =
      share * acted + dt * std::clamp(loss, -limit / relaxationTime_, limit / relaxationTime_);
  if (!still && acted == error) loss += 0.25 * share * share * error / dt;
  if (still && std::abs(loss) * relaxationTime_ <= deadband) loss = 0;
  return created / (body.room * dt);
}

void VolumeControl::addSource(const LiquidBodies& bodies, const SolidBoundary& boundary, double dt,
                              DenseField<float>& divergenceSource) {
  std::vector<float> rate(bodies.bodies.size(), 0);
  for (std::size_t n = 0; n < rate.size(); ++n) rate[n] = static_cast<float>(rateOf(bodies.bodies[n], n, dt));
  if (std::all_of(rate.begin(), rate.end(), [](float r) { return r == 0; })) return;
  forEachCell(grid_.cells, [&](int i, int j, int k) {
    const std::int32_t n = bodies.label(i, j, k);
    if (n >= 0) divergenceSource(i, j, k) += rate[n] * boundary.cellFraction(i, j, k);
  });
}

double VolumeControl::targetVolume() const {
  return ledger_.total() + std::accumulate(gas_.begin(), gas_.end(), 0.0);
}

}  // namespace spume::fluid
