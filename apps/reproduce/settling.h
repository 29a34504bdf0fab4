#pragma once

#include <algorithm>

#include "apps/reproduce/foam_bench.h"

namespace spume::apps {

/// Bubbles let rise in a square box.
struct Crowd {
  int count;
  double smallest, largest;  ///< radii [m]
  double edge, depth;        ///< of the box [m]
  bool apart;                ///< none touches another at the start
  std::uint64_t seed = 5;    ///< of radii and places
};

/// A crowd in still liquid, and what it does after 8 s.
struct Settling {
  foam::BubbleStore bubbles;
  foam::FoamStepReport report;
  double deepestInWall = 0;  ///< worst (r - psi) / r after the first second

  Settling(foam::FoamParams params, const Crowd& crowd, double dt) {
    constexpr double kTime = 8;
    const double edge = crowd.edge;
    params.bursting = false;
    foam::StillPoolParams box;
    box.lower = {-edge / 2, -crowd.depth, -edge / 2}, box.upper = {edge / 2, edge, edge / 2};
    box.closed = {true, true, true, false, true, true};
    for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(crowd.count); ++i) {
      foam::CounterRandom random(crowd.seed, i, 2);
      const double r = crowd.smallest + (crowd.largest - crowd.smallest) * random.uniform();
      Eigen::Vector3d place = drawPlace(crowd, r, random);
      while (crowd.apart && touchesAny(place, r)) place = drawPlace(crowd, r, random);
      bubbles.add({.position = place, .radius = r});
    }
    const foam::StillPool pool(box);
    foam::FoamSolver solver(params);
    for (double t = 0; t < kTime; t += dt) {
      report = solver.step(bubbles, pool, dt);
      if (t > 1) noteWalls(pool);
    }
  }

 private:
  static Eigen::Vector3d drawPlace(const Crowd& crowd, double radius, foam::CounterRandom& random) {
    const Eigen::Vector3d share = randomVector(random);
    const double room = crowd.edge - 2 * radius;
    return {(share.x() - 0.5) * room, -crowd.depth * (0.05 + 0.85 * share.y()), (share.z() - 0.5) * room};
  }
  void noteWalls(const foam::StillPool& pool) {
    Eigen::VectorXd psi(static_cast<Eigen::Index>(bubbles.size()));
    pool.psi(bubbles.positions(), psi);
    for (std::size_t i = 0; i < bubbles.size(); ++i)
      deepestInWall = std::max(deepestInWall, 1 - psi[i] / bubbles.radius[i]);
  }
  bool touchesAny(const Eigen::Vector3d& place, double radius) const {
    for (std::size_t k = 0; k < bubbles.size(); ++k)
      if ((bubbles.position[k] - place).norm() < bubbles.radius[k] + radius) return true;
    return false;
  }
};

inline constexpr Crowd kRaft{300, 0.375e-3, 1.25e-3, 30e-3, 30e-3, false};
inline constexpr Crowd kPile{300, 1.25e-3, 5e-3, 50e-3, 50e-3, false};
inline constexpr double kSmallRest = 1e-4, kLargeRest = 1e-3;  ///< rms speeds of rafts and of piles [m/s]

/// The preset without the attraction that belongs to it.
inline foam::FoamParams withoutAttraction(foam::Preset preset) {
  foam::FoamParams params = foam::makePreset(preset);
  params.attractionLaw = foam::AttractionLaw::none;
  return params;
}

/// Height of the centre of the gas above the water [m].
inline double gasHeight(const foam::BubbleStore& bubbles) {
  double gas = 0, moment = 0;
  for (std::size_t i = 0; i < bubbles.size(); ++i)
    gas += bubbles.gas[i], moment += bubbles.gas[i] * bubbles.position[i].y();
  return moment / gas;
}

}  // namespace spume::apps
