#pragma once

#include <vector>

#include "apps/reproduce/foam_bench.h"

namespace spume::apps {

/// Weightless dry foam; strong damping, because only the state at rest is asked for.
inline foam::FoamParams dryFoam() {
  foam::FoamParams params = foam::makePreset(foam::Preset::paper);
  params.gravity.setZero();
  params.wetness = params.wetnessAloft = 0;
  params.contactDamping = 1, params.bursting = false, params.solverTolerance = 1e-10;
  return params;
}

/// Up to four bubbles of these radii [m] near the corners of a tetrahedron, off by a seeded tenth of a
/// radius, let come to rest.
inline foam::BubbleStore relaxedCluster(const std::vector<double>& radii) {
  const Eigen::Vector3d corners[] = {{1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}};
  foam::BubbleStore bubbles;
  for (std::size_t i = 0; i < radii.size(); ++i) {
    foam::CounterRandom random(7 + radii.size(), i, 1);
    const Eigen::Vector3d offset = 0.1 * radii[i] * (2 * randomVector(random).array() - 1);
    bubbles.add({.position = radii[i] * 0.5 * corners[i] + offset,
                 .radius = radii[i],
                 .type = foam::BubbleClass::air});
  }
  foam::FoamSolver solver(dryFoam());
  const foam::StillPool space = emptySpace();
  for (int step = 0; step < 2000; ++step) solver.step(bubbles, space, 0.005);
  return bubbles;
}

}  // namespace spume::apps
