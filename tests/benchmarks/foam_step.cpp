/// Seconds per foam step and stage, beside what a pipeline built as in [Busaryev 2012] takes on the same
/// bubbles in the same run: CGAL's regular triangulation of all bubbles and its alpha complex anew each step,
/// Eigen's conjugate gradients with its incomplete Cholesky for the solve; the other stages as they are here.
/// Prints a table.
///
/// usage: bench_foam_step [bubbles] [wetness %] [steps] [dt ms] [pcg_ic|pcg_jacobi|cholmod] [reference 0|1]

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>

#include "foam/foam_solver.h"
#include "foam/power_diagram.h"
#include "tests/support/floating_foam.h"

namespace spume::foam::test {
namespace {

constexpr int kWarmUp = 10;  ///< steps before the clock counts: lists are built, the walls have pushed back

struct Options {
  int bubbles = 16000;
  double wetness = 0.4;
  int steps = 5;
  double dt = 5e-3;  ///< [s]
  LinearSolver solver = LinearSolver::pcgIncompleteCholesky;
  bool reference = true;

  Options(int argc, char** argv) {
    const auto number = [&](int k, double fallback) { return argc > k ? std::atof(argv[k]) : fallback; };
    bubbles = static_cast<int>(number(1, bubbles));
    wetness = number(2, 100 * wetness) / 100;
    steps = static_cast<int>(number(3, steps));
    dt = number(4, 1e3 * dt) / 1e3;
    const std::string name = argc > 5 ? argv[5] : "pcg_ic";
    if (name == "pcg_jacobi") solver = LinearSolver::pcgJacobi;
    if (name == "cholmod") solver = LinearSolver::cholmod;
    reference = number(6, 1) != 0;
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

void printReference(const Reference& reference, const StepTimes& times) {
  const double rest = times["step"] - times["geometry"] - times["solve"];
  const auto row = [](const char* name, double theirs, double ours) {
    std::printf("  %-46s %9.4f s  %6.1f times ours\n", name, theirs, theirs / ours);
  };
  std::printf("reference (%ld iterations)\n", reference.iterations);
  row("triangulation, alpha complex", reference.complex, times["geometry"]);
  row("the same with cell volumes", reference.withVolumes, times["geometry"]);
  row("Eigen conjugate gradients, incomplete Cholesky", reference.solve, times["solve"]);
  row("step without volumes", rest + reference.complex + reference.solve, times["step"]);
  row("step with volumes", rest + reference.withVolumes + reference.solve, times["step"]);
}

int run(const Options& options) {
  FloatingFoam foam(options.bubbles, options.wetness);
  foam.params.solver = options.solver;
  const StillPool pool(foam.box);
  FoamSolver solver(foam.params);
  StepTimes times;
  FoamStepReport report;
  for (int step = -kWarmUp; step < options.steps; ++step) {
    const double total = secondsOf([&] { report = solver.step(foam.bubbles, pool, options.dt); });
    if (step >= 0) times.add(report, total);
  }
  std::printf(
      "%d bubbles, wetness %.2f, dt %g ms: %.2f contacts per bubble, %d iterations, fastest %.3g m/s%s\n",
      options.bubbles, options.wetness, 1e3 * options.dt,
      2.0 * static_cast<double>(report.contacts) / options.bubbles, report.solverIterations, report.maxSpeed,
      report.solverFellBack ? ", direct solver" : "");
  for (const auto& name : times.names)
    std::printf("  %-12s %9.4f s  %8.1f ns per bubble\n", name.c_str(), times[name],
                1e9 * times[name] / options.bubbles);
  if (options.reference) printReference(Reference(foam, pool, options.dt), times);
  return 0;
}

}  // namespace
}  // namespace spume::foam::test

int main(int argc, char** argv) { return spume::foam::test::run(spume::foam::test::Options(argc, argv)); }
