#include <benchmark/benchmark.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <optional>

#include "fluid/level_set.h"
#include "fluid/liquid_solver.h"
#include "fluid/sampling.h"

namespace spume::fluid {
namespace {

/// The dam break of performance.md: a closed box of 1 m, 32 % of it water in a column against a wall.
constexpr double kColumnWidth = 0.4, kColumnHeight = 0.8;
/// The water is grown until it has run up the opposite wall and falls back: jets, sheets and drops [s].
constexpr double kGrownTime = 0.7;
/// Finer grids start from the water of this one, interpolated: growing it there takes too long.
constexpr int kGrownCells = 64;
constexpr double kFrame = 1.0 / 30;  // [s]
/// Two steps a frame, as the time step that liquid and foam share has it.
constexpr int kStepsPerFrame = 2, kStepsTaken = 2;
/// Steps of a grid that needs as many sub-steps or more, so that each has one.
constexpr int kShortSteps = 30;

LiquidSetup dam(int cells) {
  LiquidSetup setup;
  setup.grid = {Eigen::Vector3i::Constant(cells), 1.0 / cells, Eigen::Vector3d::Zero()};
  setup.walls.closed.fill(true);
  return setup;
}

double column(const Eigen::Vector3d& x) {
  const double right = x.x() - kColumnWidth, above = x.y() - kColumnHeight;
  return right > 0 && above > 0 ? std::hypot(right, above) : std::max(right, above);
}

FluidParams withMarkers(int markers) {
  FluidParams params;
  params.markersPerCell = markers;
  return params;
}

LiquidState grown(int cells, int markers) {
  LiquidSolver solver(withMarkers(markers), dam(cells), column);
  while (solver.state().time < kGrownTime) solver.step(kFrame / kStepsPerFrame);
  return solver.state();
}

/// The same water on a finer grid.
LiquidState refined(const LiquidState& coarse, int cells, int markers) {
  const double ratio = static_cast<double>(coarse.grid.cells.x()) / cells;
  const FieldView phi(coarse.phi);
  const auto surface = [&](const Eigen::Vector3d& x) {
    const Eigen::Vector3f c = coarse.grid.toCells(x).cast<float>();
    return static_cast<double>(sampleCentred(phi, c.x(), c.y(), c.z()));
  };
  LiquidState state = LiquidSolver(withMarkers(markers), dam(cells), surface).state();
  const MacView wind(coarse.velocity);
  for (int a = 0; a < 3; ++a)
    for (int i = 0; i < state.velocity[a].size().x(); ++i)
      for (int j = 0; j < state.velocity[a].size().y(); ++j)
        for (int k = 0; k < state.velocity[a].size().z(); ++k) {
          Eigen::Vector3f c = Eigen::Vector3f(i, j, k) + Eigen::Vector3f::Constant(0.5f);
          c[a] -= 0.5f;
          c *= static_cast<float>(ratio);
          const Velocity3f u = sampleVelocity(wind, c.x(), c.y(), c.z());
          state.velocity[a](i, j, k) = a == 0 ? u.x : a == 1 ? u.y : u.z;
        }
  fillGhostLayers(state.velocity);
  return state;
}

/// Grown once per grid and number of markers, the same for any number of threads. The last one is kept.
const LiquidState& water(int cells, int markers) {
  static std::pair<int, int> key;
  static std::optional<LiquidState> state;
  if (!state || key != std::pair(cells, markers)) {
    state.reset();
    state =
        cells <= kGrownCells ? grown(cells, markers) : refined(grown(kGrownCells, markers), cells, markers);
    key = {cells, markers};
  }
  return *state;
}

double residentMegabytes() {
  std::ifstream statm("/proc/self/statm");
  double total = 0, resident = 0;
  statm >> total >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}

/// Arguments: cells along an edge, markers per cell and sign, threads, steps to a frame. One iteration is two
/// steps: a frame of 1/30 s, or, where a frame takes minutes, that part of one; the counters are per
/// iteration, the stages in ms.
void damBreakFrame(benchmark::State& state) {
  const int cells = static_cast<int>(state.range(0)), markers = static_cast<int>(state.range(1));
  const LiquidState& start = water(cells, markers);
  tbb::global_control control(tbb::global_control::max_allowed_parallelism, state.range(2));
  LiquidSolver solver(withMarkers(markers), dam(cells), start);
  const double dt = kFrame / static_cast<double>(state.range(3));
  solver.step(dt);  // the first one makes memory its own
  std::map<std::string, double> stages;
  double subSteps = 0, iterations = 0, seconds = 0;
  for (auto _ : state)
    for (int step = 0; step < kStepsTaken; ++step) {
      const LiquidStepReport report = solver.step(dt);
      subSteps += report.subSteps;
      iterations += report.pressureIterations;
      for (const StageTime& stage : report.stages) stages[stage.stage] += stage.seconds;
      for (const StageTime& stage : report.stages) seconds += stage.seconds;
    }
  const auto frames = static_cast<double>(state.iterations());
  for (const auto& [stage, time] : stages) state.counters[stage + "_ms"] = 1e3 * time / frames;
  state.counters["substeps"] = subSteps / frames;
  state.counters["iterations_cg"] = iterations / subSteps;
  state.counters["ns_per_cell_and_substep"] = 1e9 * seconds / subSteps / std::pow(cells, 3);
  state.counters["markers"] =
      static_cast<double>(solver.state().positive.size() + solver.state().negative.size());
  state.counters["memory_MB"] = residentMegabytes();
}

BENCHMARK(damBreakFrame)
    ->ArgNames({"cells", "markers", "threads", "steps"})
    ->ArgsProduct({{32, 64, 128}, {16, 64}, {1, 2}, {kStepsPerFrame}})
    ->Unit(benchmark::kMillisecond)
    ->Iterations(2)
    ->UseRealTime();
BENCHMARK(damBreakFrame)
    ->ArgNames({"cells", "markers", "threads", "steps"})
    ->ArgsProduct({{256}, {16}, {1, 2}, {kShortSteps}})
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1)
    ->UseRealTime();

}  // namespace
}  // namespace spume::fluid
