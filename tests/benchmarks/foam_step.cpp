/// Seconds per foam step and stage, beside what a pipeline built as in [Busaryev 2012] takes on the same
/// bubbles in the same run: CGAL's regular triangulation of all bubbles and its alpha complex anew each step,
/// Eigen's conjugate gradients with its incomplete Cholesky for the solve; the other stages as they are here.
/// Prints a table.
///
/// usage: bench_foam_step [bubbles] [wetness %] [steps] [dt ms] [pcg_ic|pcg_jacobi|cholmod] [reference 0|1]
///                        [contacts|attraction|newton] [tolerance]
///        bench_foam_step all FILE.csv
/// `contacts`: forces between bubbles in contact, walls, liquid; volumes relaxed. `attraction`: also that of
/// floating bubbles, the preset as it is. `newton`: both, and every cell made to hold its gas. `all` runs 4K,
/// 16K, 100K and 1M bubbles, wet and dense, each beside its reference, and dense ones with all else and at
/// the tolerance of the scenes of coke; FILE.csv gets a row a stage.

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "foam/foam_solver.h"
#include "foam/power_diagram.h"
#include "tests/support/floating_foam.h"

namespace spume::foam::test {
namespace {

constexpr double kCoke = 1e-4;  ///< foam.solver_tolerance of the scenes of coke
constexpr int kWarmUp = 10;  ///< steps before the clock counts: lists are built, the walls have pushed back

struct Options {
  int bubbles = 16000;
  double wetness = 0.4;
  int steps = 5;
  double dt = 5e-3;  ///< [s]
  LinearSolver solver = LinearSolver::pcgIncompleteCholesky;
  bool reference = true;
  std::string forces = "contacts";
  double tolerance = FoamParams().solverTolerance;

  Options() = default;
  /// Exits where the command line is none.
  Options(int argc, char** argv) {
    const auto number = [&](int k, double fallback, double least) {
      if (argc <= k) return fallback;
      char* end = nullptr;
      const double value = std::strtod(argv[k], &end);
      if (end == argv[k] || *end != 0 || !(value >= least)) refuse(argv[k]);
      return value;
    };
    bubbles = static_cast<int>(number(1, bubbles, 2));
    wetness = number(2, 100 * wetness, 0) / 100;
    steps = static_cast<int>(number(3, steps, 1));
    dt = number(4, 1e3 * dt, 1e-3) / 1e3;
    const std::string name = argc > 5 ? argv[5] : "pcg_ic";
    if (name == "pcg_jacobi")
      solver = LinearSolver::pcgJacobi;
    else if (name == "cholmod")
      solver = LinearSolver::cholmod;
    else if (name != "pcg_ic")
      refuse(name);
    reference = number(6, 1, 0) != 0;
    if (argc > 7) forces = argv[7];
    if (forces != "contacts" && forces != "attraction" && forces != "newton") refuse(forces);
    tolerance = number(8, tolerance, 1e-12);
  }

  [[noreturn]] static void refuse(const std::string& word) {
    std::fprintf(
        stderr,
        "bench_foam_step: %s does not fit\nusage: bench_foam_step [bubbles >= 2] [wetness %%] [steps >= 1] "
        "[dt ms] [pcg_ic|pcg_jacobi|cholmod] [reference 0|1] [contacts|attraction|newton] [tolerance >= "
        "1e-12]\n"
        "       bench_foam_step all FILE.csv\n",
        word.c_str());
    std::exit(2);
  }
};

template <typename Body>
double secondsOf(const Body& body) {
  const auto start = std::chrono::steady_clock::now();
  body();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double medianOf(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// The matrix of a step as Eigen takes it, all of it.
Eigen::SparseMatrix<double> sparseMatrix(const BlockSystem& a) {
  std::vector<Eigen::Triplet<double>> entries;
  const auto add = [&](std::size_t i, std::size_t j, const Eigen::Matrix3d& block) {
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c)
        entries.emplace_back(static_cast<int>(3 * i) + r, static_cast<int>(3 * j) + c, block(r, c));
  };
  for (std::size_t i = 0; i < a.size(); ++i) {
    add(i, i, a.diagonal(i));
    for (std::int32_t e = a.start[i]; e < a.start[i + 1]; ++e)
      add(i, static_cast<std::size_t>(a.other[e]),
          -(a.block[e].along() * a.block[e].along().transpose() +
            a.block[e].across() * Eigen::Matrix3d::Identity()));
  }
  Eigen::SparseMatrix<double> matrix(static_cast<Eigen::Index>(3 * a.size()),
                                     static_cast<Eigen::Index>(3 * a.size()));
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/// The reference's stages on the bubbles as they are.
struct Reference {
  double complex = 0, withVolumes = 0, solve = 0;  ///< [s]
  long iterations = 0;

  Reference(const FloatingFoam& foam, const StillPool& pool, double dt) {
    BubbleStore bubbles = inSpaceOrder(foam.bubbles);
    FoamTopology topology;
    complex = secondsOf([&] { alphaComplexEdges(bubbles.position, bubbles.radius, bubbles.id, 0); });
    withVolumes =
        secondsOf([&] { PowerDiagram().compute(bubbles.position, bubbles.radius, bubbles.id, topology); });
    Integrator integrator(foam.params);
    coupleOnce(integrator, pool, dt, topology, bubbles);
    const Eigen::SparseMatrix<double> matrix = sparseMatrix(integrator.system());
    const Eigen::Map<const Eigen::VectorXd> right(integrator.impulses().front().data(), matrix.rows());
    Eigen::ConjugateGradient<Eigen::SparseMatrix<double>, Eigen::Lower | Eigen::Upper,
                             Eigen::IncompleteCholesky<double>>
        solver;
    solver.setTolerance(foam.params.solverTolerance);
    solve = secondsOf([&] { solver.compute(matrix).solve(right).eval(); });
    iterations = solver.iterations();
  }
};

struct StepTimes {
  std::vector<std::string> names;
  std::map<std::string, std::vector<double>> seconds;

  void add(const FoamStepReport& report, double total) {
    names.clear();
    for (const auto& stage : report.stages)
      names.push_back(stage.stage), seconds[stage.stage].push_back(stage.seconds);
    names.emplace_back("step"), seconds["step"].push_back(total);
  }
  double operator[](const std::string& name) const { return medianOf(seconds.at(name)); }
};

/// What the run of one foam gives: named seconds, and what the foam was.
struct Result {
  Options options;
  double contacts = 0;    ///< a bubble
  double iterations = 0;  ///< a step, mean
  FoamStepReport last;
  std::vector<std::pair<std::string, double>> stages;     ///< of the step, itself the last [s]
  std::vector<std::pair<std::string, double>> reference;  ///< [s]
};

Result measure(const Options& options) {
  FloatingFoam foam(options.bubbles, options.wetness);
  foam.params.solver = options.solver, foam.params.solverTolerance = options.tolerance;
  if (options.forces == "contacts") foam.params.attractionLaw = AttractionLaw::none;
  if (options.forces == "newton") foam.params.volumeMode = VolumeMode::newton;
  const StillPool pool(foam.box);
  FoamSolver solver(foam.params);
  StepTimes times;
  Result result{options, 0, 0, {}, {}, {}};
  for (int step = -kWarmUp; step < options.steps; ++step) {
    const double total = secondsOf([&] { result.last = solver.step(foam.bubbles, pool, options.dt); });
    if (step < 0) continue;
    times.add(result.last, total);
    result.iterations += result.last.solverIterations / static_cast<double>(options.steps);
  }
  result.contacts = 2.0 * static_cast<double>(result.last.contacts) / options.bubbles;
  for (const auto& name : times.names) result.stages.emplace_back(name, times[name]);
  if (!options.reference) return result;
  const Reference reference(foam, pool, options.dt);
  const double rest = times["step"] - times["geometry"] - times["solve"];
  result.reference = {{"reference complex", reference.complex},
                      {"reference complex with volumes", reference.withVolumes},
                      {"reference solve", reference.solve},
                      {"reference step", rest + reference.complex + reference.solve},
                      {"reference step with volumes", rest + reference.withVolumes + reference.solve}};
  return result;
}

void print(const Result& result) {
  const Options& options = result.options;
  std::printf(
      "%d bubbles, wetness %.2f, dt %g ms, %s to %g: %.2f contacts per bubble, %.1f iterations, fastest %.3g "
      "m/s%s\n",
      options.bubbles, options.wetness, 1e3 * options.dt, options.forces.c_str(), options.tolerance,
      result.contacts, result.iterations, result.last.maxSpeed,
      result.last.solverFellBack ? ", direct solver" : "");
  for (const auto& [name, seconds] : result.stages)
    std::printf("  %-12s %9.4f s  %8.1f ns per bubble\n", name.c_str(), seconds,
                1e9 * seconds / options.bubbles);
  const double step = result.stages.back().second;
  for (const auto& [name, seconds] : result.reference)
    std::printf("  %-32s %9.4f s  %6.1f times our step\n", name.c_str(), seconds, seconds / step);
  std::fflush(stdout);
}

/// Appends a row a stage.
void write(const Result& result, std::FILE* table) {
  for (const auto* part : {&result.stages, &result.reference})
    for (const auto& [name, seconds] : *part)
      std::fprintf(table, "%d,%g,%s,%g,%.2f,%.1f,%s,%.5g,%.5g\n", result.options.bubbles,
                   result.options.wetness, result.options.forces.c_str(), result.options.tolerance,
                   result.contacts, result.iterations, name.c_str(), seconds,
                   1e9 * seconds / result.options.bubbles);
  std::fflush(table);
}

int runAll(const char* path) {
  std::FILE* table = std::fopen(path, "w");
  if (table == nullptr) {
    std::fprintf(stderr, "bench_foam_step: %s: cannot be written\n", path);
    return 4;
  }
  std::fprintf(
      table, "bubbles,wetness,forces,tolerance,contacts_per_bubble,iterations,stage,seconds,ns_per_bubble\n");
  const auto add = [&](const Options& options) {
    const Result result = measure(options);
    print(result), write(result, table);
  };
  for (const int bubbles : {4000, 16000, 100000, 1000000}) {
    Options options;
    options.bubbles = bubbles, options.steps = bubbles > 100000 ? 3 : 9;
    for (const double wetness : {0.4, 0.8}) options.wetness = wetness, add(options);
    options.wetness = 0.4, options.reference = false;
    for (const char* forces : {"attraction", "newton"}) options.forces = forces, add(options);
    options.forces = "contacts", options.tolerance = kCoke, add(options);
  }
  return std::fclose(table) == 0 ? 0 : 4;
}

int run(int argc, char** argv) {
  if (argc > 1 && std::string(argv[1]) == "all") {
    if (argc != 3) Options::refuse("all");
    return runAll(argv[2]);
  }
  print(measure(Options(argc, argv)));
  return 0;
}

}  // namespace
}  // namespace spume::foam::test

int main(int argc, char** argv) { return spume::foam::test::run(argc, argv); }
