#pragma once

#include <vector>

#include "tests/foam_fixtures.h"

namespace spume::foam::test {

/// What the foam makes of a crowd, for programs compiled differently to compare: cells of a dense foam, then
/// bubbles that rise into a pile.
struct FoamSample {
  std::vector<double> cells;   ///< volumes, free areas and film areas, radii about 1
  std::vector<double> motion;  ///< places [mm] and radii [mm] after some steps

  FoamSample() { measure(), rise(); }

 private:
  void measure() {
    const FoamTopology topology = powerCellsOf(randomFoam(3000, 0.5, 4, 1, 11));
    for (const auto* column : {&topology.volume, &topology.freeArea, &topology.filmArea})
      cells.insert(cells.end(), column->begin(), column->end());
    cells.push_back(static_cast<double>(topology.films.size()));
  }

  /// From a lattice slightly out of order: where bubbles begin in each other, what rounding changes grows
  /// hundredfold a step.
  void rise() {
    constexpr int kAlong = 7, kSteps = 8;
    constexpr double kApart = 2.6e-3, kEdge = kAlong * kApart, kDt = 10e-3;  // [m], [m], [s]
    FoamParams params = makePreset(Preset::physical);
    params.solverTolerance = 1e-12, params.volumeMode = VolumeMode::newton, params.volumeTolerance = 1e-8;
    params.bursting = false;
    StillPoolParams box;
    box.gravity = params.gravity, box.density = params.density;
    box.lower = {0, -kEdge, 0}, box.upper = {kEdge, kEdge, kEdge};
    box.closed = {true, true, true, false, true, true};
    BubbleStore bubbles;
    for (int i = 0; i < kAlong * kAlong * kAlong; ++i) {
      CounterRandom random(3, static_cast<std::uint64_t>(i), 0);
      const double x = random.uniform(), y = random.uniform(), z = random.uniform();
      const Eigen::Vector3d site(i % kAlong + 0.5, -(i / kAlong % kAlong) - 0.5, i / (kAlong * kAlong) + 0.5);
      const Eigen::Vector3d place = kApart * (site + 0.1 * Eigen::Vector3d(x - 0.5, y - 0.5, z - 0.5));
      bubbles.add(bubbleAt(place, 0.4e-3 + 0.8e-3 * random.uniform()));
    }
    FoamSolver solver(params);
    for (int step = 0; step < kSteps; ++step) solver.step(bubbles, StillPool(box), kDt);
    for (std::size_t i = 0; i < bubbles.size(); ++i) {
      for (const double x : bubbles.position[i]) motion.push_back(1e3 * x);
      motion.push_back(1e3 * bubbles.radius[i]);
    }
  }
};

}  // namespace spume::foam::test
