#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "fluid/projection.h"
#include "fluid/solid_boundary.h"

namespace spume::fluid {
namespace {

/// Half-full tank with a jet, 40 pockets, 40 drops and a cut-cell sphere (performance.md), velocities random.
struct Tank {
  GridSpec grid;
  FluidParams params;
  SolidBoundary boundary;
  DenseField<float> phi, source;
  MacVelocity velocity;
  MacField<float> gradient;

  explicit Tank(int n)
      : grid{Eigen::Vector3i::Constant(n), 0.16 / n, Eigen::Vector3d::Zero()},
        boundary(buildSolidBoundary(grid, DomainWalls{}, {ball()}, 0)),
        phi(grid.cells),
        source(grid.cells, 0),
        velocity(grid.cells),
        gradient(grid.cells) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(0, 1);
    std::vector<Eigen::Vector4d> spheres;  // the even ones are air in the pool, the odd ones drops above it
    for (int s = 0; s < 80; ++s)
      spheres.emplace_back(0.16 * uniform(random), 0.08 * uniform(random) + (s % 2 ? 0.08 : 0),
                           0.16 * uniform(random), 0.004 + 0.004 * uniform(random));
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        for (int k = 0; k < n; ++k)
          phi(i, j, k) = static_cast<float>(surface(spheres, grid.cellCentre(i, j, k)));
    for (int a = 0; a < 3; ++a)
      std::generate_n(velocity[a].data(), velocity[a].count(),
                      [&] { return static_cast<float>(uniform(random) - 0.5); });
  }

  static SolidObject ball() {
    return {
        "ball",
        [](const Eigen::Vector3d& x, double) { return (x - Eigen::Vector3d(.05, .05, .06)).norm() - .03; },
        {},
        false};
  }
  static double surface(const std::vector<Eigen::Vector4d>& spheres, const Eigen::Vector3d& x) {
    double phi = std::min(x.y() - 0.08123, std::hypot(x.x() - 0.08, x.z() - 0.08) - 0.01);
    for (std::size_t s = 0; s < spheres.size(); ++s) {
      const double distance = (x - spheres[s].head<3>()).norm() - spheres[s].w();
      phi = s % 2 ? std::min(phi, distance) : std::max(phi, -distance);
    }
    return phi;
  }
};

/// Arguments: cells along an edge, threads.
void projectTank(benchmark::State& state) {
  tbb::global_control control(tbb::global_control::max_allowed_parallelism, state.range(1));
  Tank tank(static_cast<int>(state.range(0)));
  Projection projection(tank.grid, tank.params);
  ProjectionReport report;
  for (auto _ : state) {
    state.PauseTiming();
    MacVelocity velocity = tank.velocity;
    state.ResumeTiming();
    report = projection.project(tank.phi, tank.boundary, 0.004, tank.source, velocity, tank.gradient);
  }
  state.counters["iterations_cg"] = report.iterations;
  state.counters["divergence"] = report.divergence;
}
BENCHMARK(projectTank)->ArgsProduct({{32, 64, 128}, {1, 2}})->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace spume::fluid
