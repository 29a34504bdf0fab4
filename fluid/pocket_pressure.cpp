// The part of the projection that concerns closed pockets of air.
#include <algorithm>
#include <numeric>

#include "fluid/projection_system.h"

namespace spume::fluid {
namespace {

std::size_t rootOf(std::vector<std::size_t>& parent, std::size_t n) {
  while (parent[n] != n) n = parent[n] = parent[parent[n]];
  return n;
}

}  // namespace

void ProjectionSystem::findPocketSurfaces() {
  if (held && held->pockets.empty()) held = nullptr;
  const std::size_t count = held ? held->pockets.size() : 0;
  pockets.clear(count);
  pocketPressure.assign(count, 0);
  vented.assign(count, 0);
  if (!held) return;
  std::vector<std::uint8_t> open(components.size(), 0);
  forEachSurfaceCell([&](const Component&, const Eigen::Vector3i& c) {
    for (int a = 0; a < 3; ++a)
      for (int side : {-1, 1}) {
        if (!isSurface(c, a, side)) continue;
        const std::int32_t pocket = pocketBeside(c, a, side);
        if (pocket < 0)
          open[component(c)] = 1;
        else
          pockets.surfaces.push_back({c, a, side, pocket, surfaceBeside(c, a, side).coefficient, 0});
      }
  });
  ventSealedPockets(open);
  pockets.finish();
}

/// A group of bodies and pockets without any open air has no pressure to refer to: its largest pocket counts
/// as open air, and holds its gas by what the others and the liquid leave.
void ProjectionSystem::ventSealedPockets(const std::vector<std::uint8_t>& openBodies) {
  const std::size_t bodies = components.size(), count = bodies + held->pockets.size();
  std::vector<std::size_t> parent(count);
  std::iota(parent.begin(), parent.end(), 0);
  for (const PocketSurface& s : pockets.surfaces) {
    const std::size_t a = rootOf(parent, component(s.cell)), b = rootOf(parent, bodies + s.pocket);
    parent[std::max(a, b)] = std::min(a, b);
  }
  std::vector<std::uint8_t> open(count, 0);
  for (std::size_t n = 0; n < bodies; ++n) open[rootOf(parent, n)] |= openBodies[n];
  std::vector<std::ptrdiff_t> largest(count, -1);
  for (std::size_t p = 0; p < vented.size(); ++p) {
    std::ptrdiff_t& best = largest[rootOf(parent, bodies + p)];
    if (best < 0 || held->pockets[p].cells.size() > held->pockets[best].cells.size())
      best = static_cast<std::ptrdiff_t>(p);
  }
  for (std::size_t n = 0; n < count; ++n)
    if (largest[n] >= 0 && !open[n]) vented[largest[n]] = 1;
  std::erase_if(pockets.surfaces, [&](const PocketSurface& s) { return vented[s.pocket] != 0; });
}

/// Takes the pockets' own hydrostatic pressure out of their unknowns: the mean over their surfaces of what
/// the bodies with open air there expect, so that all unknowns of a state of rest are 0.
void ProjectionSystem::levelPockets() {
  std::vector<double> sum(pocketPressure.size(), 0), count(pocketPressure.size(), 0);
  for (const PocketSurface& s : pockets.surfaces) {
    const Component& body = components[component(s.cell)];
    if (!body.hydrostatic || body.openSurfaces == 0) continue;
    const double theta = surfaceBeside(s.cell, s.axis, s.side).theta;
    sum[s.pocket] += dt / grid.dx * (gravityAtSurface(s.cell, s.axis, s.side, theta) - body.level);
    ++count[s.pocket];
  }
  for (std::size_t p = 0; p < sum.size(); ++p) pocketPressure[p] = count[p] > 0 ? sum[p] / count[p] : 0;
  for (PocketSurface& s : pockets.surfaces) {
    const Component& body = components[component(s.cell)];
    const double theta = surfaceBeside(s.cell, s.axis, s.side).theta;
    s.known = surfaceValue(body, s.cell, s.axis, s.side, theta);
  }
}

/// Once it is decided which bodies fall freely, levels the pockets beside the others alone.
void ProjectionSystem::relevelPockets() {
  const bool anyPlain = std::any_of(pockets.surfaces.begin(), pockets.surfaces.end(), [&](const auto& s) {
    return !components[component(s.cell)].hydrostatic;
  });
  if (!anyPlain) return;
  for (const PocketSurface& s : pockets.surfaces) {
    const double theta = surfaceBeside(s.cell, s.axis, s.side).theta;
    const bool hydrostatic = components[component(s.cell)].hydrostatic;
    rhs(s.cell) -= s.coefficient * (hydrostatic ? s.known : tension(s.cell, s.axis, s.side, theta));
  }
  levelPockets();
  for (const PocketSurface& s : pockets.surfaces) rhs(s.cell) += s.coefficient * s.known;
}

/// What solids and inflows push into a pocket through the closed parts of its faces, over dx^2 [m/s].
double ProjectionSystem::solidFlowInto(const AirPocket& pocket) const {
  double flow = 0;
  for (const Eigen::Vector3i& c : pocket.cells)
    for (int a = 0; a < 3; ++a)
      for (int side : {-1, 1}) {
        const Eigen::Vector3i face = side > 0 ? c + Eigen::Vector3i::Unit(a) : c;
        flow -= side * (1.0 - boundary->open[a](face)) * boundary->velocity[a](face);
      }
  return flow;
}

/// c_p = growth + flow of solids into p + sum over its surfaces of (flow of the liquid into it - coefficient
/// times known pressure): the volume of gas changes by its growth alone.
void ProjectionSystem::assemblePockets(const MacVelocity& velocity) {
  for (std::size_t p = 0; p < pockets.residual.size(); ++p) {
    if (!(pockets.diagonal[p] > 0)) continue;
    pockets.residual[p] = held->growth[p] / (grid.dx * grid.dx) + solidFlowInto(held->pockets[p]);
  }
  for (const PocketSurface& s : pockets.surfaces) {
    const Eigen::Vector3i face = s.side > 0 ? s.cell + Eigen::Vector3i::Unit(s.axis) : s.cell;
    const bool falls = !components[component(s.cell)].hydrostatic;
    const double u = velocity[s.axis](face) + (falls ? dt * params.gravity[s.axis] : 0);
    pockets.residual[s.pocket] += boundary->open[s.axis](face) * s.side * u - s.coefficient * s.known;
  }
}

}  // namespace spume::fluid
