/// Seconds per geometry update, local engine against CGAL, on the foams of performance, "Foam geometry".
/// Compare within one run. For one thread: taskset -c 0. For a file:
/// --benchmark_out=data/benchmarks/<machine>/foam_geometry.json

#include <benchmark/benchmark.h>

#include <map>

#include "foam/power_cells.h"
#include "foam/power_diagram.h"
#include "foam/weak_pairs.h"
#include "tests/support/foam_relaxed.h"

namespace spume::foam::test {
namespace {

const Balls& foamOf(int count, double wetness) {
  static std::map<std::pair<int, double>, Balls> made;
  const auto [place, isNew] = made.try_emplace({count, wetness});
  if (isNew) place->second = relaxedFoam(count, wetness, 1);
  return place->second;
}

const Balls& foamOf(const benchmark::State& state) {
  return foamOf(static_cast<int>(state.range(0)), static_cast<double>(state.range(1)) / 100);
}

void report(benchmark::State& state, const FoamTopology& topology) {
  const auto count = static_cast<double>(topology.volume.size());
  state.counters["contacts_per_bubble"] = 2 * static_cast<double>(topology.films.size()) / count;
  state.counters["per_bubble"] =
      benchmark::Counter(count, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void localListReused(benchmark::State& state) {
  const Balls& balls = foamOf(state);
  PowerCells cells;
  FoamTopology topology;
  cells.compute(balls.position, balls.radius, balls.id, topology);
  for (auto _ : state) cells.compute(balls.position, balls.radius, balls.id, topology);
  report(state, topology);
}

void localFromScratch(benchmark::State& state) {
  const Balls& balls = foamOf(state);
  FoamTopology topology;
  for (auto _ : state) PowerCells().compute(balls.position, balls.radius, balls.id, topology);
  report(state, topology);
}

void cgalTriangulationAndAlphaComplex(benchmark::State& state) {
  const Balls& balls = foamOf(state);
  for (auto _ : state) benchmark::DoNotOptimize(alphaComplexEdges(balls.position, balls.radius, balls.id, 0));
}

void cgalWithVolumes(benchmark::State& state) {
  const Balls& balls = foamOf(state);
  FoamTopology topology;
  for (auto _ : state) PowerDiagram().compute(balls.position, balls.radius, balls.id, topology);
  report(state, topology);
}

/// A raft: the lower layer of a foam, flattened, all of it at the surface.
void weakPairsOfRaft(benchmark::State& state) {
  constexpr double kRange = 13.6e-3;  // 5 capillary lengths of water
  Balls raft = foamOf(static_cast<int>(state.range(0)), 0.8);
  const double spread =
      std::sqrt(static_cast<double>(raft.size())) / std::cbrt(static_cast<double>(raft.size()));
  for (auto& x : raft.position) x = Eigen::Vector3d(spread * x.x(), 0.05 * x.y(), spread * x.z());
  const std::vector<std::uint8_t> surface(raft.size(), 1);
  const FoamTopology topology = powerCellsOf(raft);
  std::vector<WeakPair> weak;
  for (auto _ : state) WeakPairs().find(raft.position, raft.radius, raft.id, surface, topology, kRange, weak);
  state.counters["weak_per_bubble"] = 2 * static_cast<double>(weak.size()) / static_cast<double>(raft.size());
}

void sizes(benchmark::internal::Benchmark* bench) {
  bench->ArgNames({"bubbles", "wetness%"})->UseRealTime()->Unit(benchmark::kMillisecond);
  for (int count : {4000, 16000, 100000})
    for (int wetness : {80, 40}) bench->Args({count, wetness});
}

BENCHMARK(localListReused)->Apply(sizes);
BENCHMARK(localFromScratch)->Apply(sizes);
BENCHMARK(cgalTriangulationAndAlphaComplex)->Apply(sizes);
BENCHMARK(cgalWithVolumes)->Apply(sizes);
BENCHMARK(weakPairsOfRaft)
    ->ArgName("bubbles")
    ->Arg(1000)
    ->Arg(4000)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace spume::foam::test
