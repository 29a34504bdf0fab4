/// Milliseconds and iterations of the linear solvers on one system of a step, from rest, to a relative
/// residual of 1e-6: dense foams of 100 to 100000 bubbles, steps of 1 to 20 ms, springs of 0.3 to 8 N/m.
/// Prints a table.
///
/// usage: bench_foam_solvers [most bubbles, default 16000] [most bubbles for cholmod, 1000]

#include <chrono>
#include <cstdio>
#include <cstdlib>

#include "tests/support/floating_foam.h"

namespace spume::foam::test {
namespace {

constexpr double kTolerance = 1e-6;

struct Timed {
  double seconds;
  SolveReport report;
};

Timed timeSolve(LinearSolver kind, const BlockSystem& a, const Vectors3& b) {
  ImplicitSolve solver(kind);
  Timed timed{1e300, {}};
  for (int repeat = 0; repeat < 2; ++repeat) {  // the first one makes room
    Vectors3 x(a.size(), Eigen::Vector3d::Zero());
    const double goal = kTolerance * solver.residual(a, b, x);
    const auto start = std::chrono::steady_clock::now();
    timed.report = solver.solve(a, b, goal, 100000, x);
    timed.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  return timed;
}

void printRow(const FloatingFoam& foam, const StillPool& pool, double k, double dt, bool direct) {
  FoamParams params = foam.params;
  params.springFromSurfaceTension = false, params.springStiffness = k, params.springFloor = 0;
  params.solverIterations = 100000;
  BubbleStore bubbles = inSpaceOrder(foam.bubbles);
  FoamTopology topology;
  PowerCells().compute(bubbles.position, bubbles.radius, bubbles.id, topology);
  Integrator integrator(params);
  coupleOnce(integrator, pool, dt, topology, bubbles);
  std::printf("%7zu %5g %5g", bubbles.size(), 1e3 * dt, k);
  for (const auto kind :
       {LinearSolver::pcgJacobi, LinearSolver::pcgIncompleteCholesky, LinearSolver::cholmod}) {
    if (kind == LinearSolver::cholmod && !direct) continue;
    const Timed timed = timeSolve(kind, integrator.system(), integrator.impulses());
    std::printf("   %5d %9.2f", timed.report.iterations, 1e3 * timed.seconds);
  }
  std::printf("\n");
  std::fflush(stdout);
}

int run(int most, int mostDirect) {
  std::printf("bubbles dt ms k N/m    pcg_jacobi: its, ms   pcg_ic: its, ms   cholmod: its, ms\n");
  for (int count : {100, 1000, 4000, 16000, 100000}) {
    if (count > most) break;
    const FloatingFoam foam(count, 0.4);
    const StillPool pool(foam.box);
    for (double k : {0.3, 2.0, 8.0})
      for (double dt : {1e-3, 5e-3, 20e-3}) printRow(foam, pool, k, dt, count <= mostDirect);
  }
  return 0;
}

}  // namespace
}  // namespace spume::foam::test

int main(int argc, char** argv) {
  return spume::foam::test::run(argc > 1 ? std::atoi(argv[1]) : 16000, argc > 2 ? std::atoi(argv[2]) : 1000);
}
