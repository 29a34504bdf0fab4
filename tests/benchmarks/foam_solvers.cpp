/// The linear solvers on one system of a step, from rest, to a relative residual of 1e-6: iterations and
/// milliseconds with the set-up in them, and the set-up by itself, the quickest of four (threads that wait
/// for each other use processor time that says nothing), for dense foams of 100 to 100000 bubbles, steps of 1
/// to 20 ms, springs of 0.3 to 8 N/m. Then what the tolerance buys in one step, and in ten beside what the
/// step does. Prints tables in Markdown.
///
/// usage: bench_foam_solvers [most bubbles, default 16000] [most bubbles for cholmod, 1000]
/// Beyond the latter cholmod factors one system of each size, once; "-" where its factor does not fit.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>

#include "foam/coarse_correction.h"
#include "foam/crew.h"
#include "foam/direct_solve.h"
#include "foam/foam_solver.h"
#include "foam/incomplete_cholesky.h"
#include "tests/support/floating_foam.h"

namespace spume::foam::test {
namespace {

constexpr double kTolerance = 1e-6;

struct Timed {
  double seconds;
  SolveReport report;
};

double secondsNow() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

Timed timeSolve(LinearSolver kind, const BlockSystem& a, const Vectors3& b, double tolerance, Vectors3& x) {
  ImplicitSolve solver(kind);
  Timed timed{1e300, {}};
  for (int repeat = 0; repeat < 4; ++repeat) {  // the first one makes room
    x.assign(a.size(), Eigen::Vector3d::Zero());
    const double goal = tolerance * solver.begin(a, b, x);
    const double start = secondsNow();
    timed.report = solver.solve(a, b, goal, 100000, x);
    timed.seconds = std::min(timed.seconds, secondsNow() - start);
  }
  return timed;
}

/// Of what a solver does before its first iteration; cholmod's factor is all of its work.
double secondsOfSetUp(LinearSolver kind, const BlockSystem& a) {
  double quickest = 1e300;
  const bool factors = kind == LinearSolver::pcgIncompleteCholesky;
  SweptSystem swept;
  IncompleteCholesky factor;
  CoarseCorrection coarse;
  for (int repeat = 0; repeat < 4; ++repeat) {
    const double start = secondsNow();
    swept.copy(a, factors);
    Crew::lead(swept.tasks(), [&](Crew& crew) { factor.factor(crew, swept); });
    coarse.build(a, swept, factors);
    quickest = std::min(quickest, secondsNow() - start);
  }
  return quickest;
}

/// Seconds of a direct solve, or 0 where its factor does not fit.
double secondsOfDirect(const BlockSystem& a, const Vectors3& b, bool once) {
  Vectors3 x(a.size(), Eigen::Vector3d::Zero());
  DirectSolve direct;
  double quickest = 1e300;
  for (int repeat = 0; repeat < (once ? 1 : 4); ++repeat) {
    const double start = secondsNow();
    if (!direct.factor(a)) return 0;
    direct.improve(b, x);
    quickest = std::min(quickest, secondsNow() - start);
  }
  return quickest;
}

/// The system of a step of `dt` [s] with springs of `k` [N/m].
Integrator systemOf(const FloatingFoam& foam, const StillPool& pool, double k, double dt) {
  FoamParams params = foam.params;
  params.springFromSurfaceTension = false, params.springStiffness = k, params.springFloor = 0;
  params.solverIterations = 100000;
  BubbleStore bubbles = inSpaceOrder(foam.bubbles);
  FoamTopology topology;
  PowerCells().compute(bubbles.position, bubbles.radius, bubbles.id, topology);
  Integrator integrator(params);
  coupleOnce(integrator, pool, dt, topology, bubbles);
  return integrator;
}

/// With `direct`, cholmod too: four times in small foams, otherwise once.
void printRow(const FloatingFoam& foam, const StillPool& pool, double k, double dt, bool direct, bool once) {
  const Integrator integrator = systemOf(foam, pool, k, dt);
  const BlockSystem& a = integrator.system();
  std::printf("| %zu | %g | %g |", foam.bubbles.size(), 1e3 * dt, k);
  Vectors3 x;
  for (const auto kind : {LinearSolver::pcgJacobi, LinearSolver::pcgIncompleteCholesky}) {
    const Timed timed = timeSolve(kind, a, integrator.impulses(), kTolerance, x);
    std::printf(" %d | %.3g | %.3g |", timed.report.iterations, 1e3 * timed.seconds,
                1e3 * secondsOfSetUp(kind, a));
  }
  const double seconds = direct ? secondsOfDirect(a, integrator.impulses(), once) : 0;
  seconds > 0 ? std::printf(" %.3g |\n", 1e3 * seconds) : std::printf(" - |\n");
  std::fflush(stdout);
}

/// How far velocities are off those of a solution to round-off, over the largest of them.
void printTolerances(int count) {
  constexpr double kExact = 1e-12, kStiffness = 2, kStep = 5e-3;
  const FloatingFoam foam(count, 0.4);
  const Integrator integrator = systemOf(foam, StillPool(foam.box), kStiffness, kStep);
  Vectors3 exact, x;
  timeSolve(LinearSolver::pcgIncompleteCholesky, integrator.system(), integrator.impulses(), kExact, exact);
  double largest = 0;
  for (const auto& v : exact) largest = std::max(largest, v.norm());
  std::printf("\n| tolerance, %d bubbles | pcg_ic iterations | ms | worst error | median error |\n", count);
  std::printf("|---|---|---|---|---|\n");
  for (const double tolerance : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-8}) {
    const Timed timed = timeSolve(LinearSolver::pcgIncompleteCholesky, integrator.system(),
                                  integrator.impulses(), tolerance, x);
    std::vector<double> error;
    for (std::size_t i = 0; i < x.size(); ++i) error.push_back((x[i] - exact[i]).norm() / largest);
    std::sort(error.begin(), error.end());
    std::printf("| %g | %d | %.3g | %.2g | %.2g |\n", tolerance, timed.report.iterations, 1e3 * timed.seconds,
                error.back(), error[error.size() / 2]);
  }
}

/// What ten steps leave of a foam under way.
struct Played {
  BubbleStore bubbles;
  int iterations = 0;
};

/// `seconds` of the foam in equal steps.
Played play(const FloatingFoam& foam, double tolerance, double seconds, int steps) {
  FoamParams params = foam.params;
  params.solverTolerance = tolerance;
  const StillPool pool(foam.box);
  FoamSolver solver(params);
  Played played = {foam.bubbles, 0};
  for (int k = 0; k < steps; ++k)
    played.iterations += solver.step(played.bubbles, pool, seconds / steps).solverIterations;
  return played;
}

/// How far bubbles are after 50 ms from where steps of 5 ms solved to 1e-9 bring them, in radii: at other
/// tolerances, and with other steps. What the smallest tolerances still show is how quickly a foam forgets: a
/// few bubbles are thrown from the surface, and where they land is chance.
void printDrift(int count) {
  constexpr double kSeconds = 50e-3, kWarmUp = 75e-3, kExact = 1e-9;
  constexpr int kSteps = 10;
  FloatingFoam foam(count, 0.4);
  foam.bubbles = play(foam, kExact, kWarmUp, 15).bubbles;
  const BubbleStore exact = play(foam, kExact, kSeconds, kSteps).bubbles;
  std::printf(
      "\n| %d bubbles, 50 ms | iterations | half within | 9 of 10 | 99 of 100 |\n|---|---|---|---|---|\n",
      count);
  const auto print = [&](const char* what, double value, const Played& played) {
    std::vector<double> off;
    for (std::size_t i = 0; i < exact.size(); ++i)
      off.push_back((played.bubbles.position[i] - exact.position[i]).norm() / exact.radius[i]);
    std::sort(off.begin(), off.end());
    const auto share = [&](double of) {
      return off[static_cast<std::size_t>(of * static_cast<double>(off.size() - 1))];
    };
    std::printf("| %s %g | %d | %.2g r | %.2g r | %.2g r |\n", what, value, played.iterations, share(0.5),
                share(0.9), share(0.99));
    std::fflush(stdout);
  };
  for (const double tolerance : {1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2})
    print("tolerance", tolerance, play(foam, tolerance, kSeconds, kSteps));
  for (const int steps : {12, 20, 40})
    print("dt ms", 1e3 * kSeconds / steps, play(foam, kExact, kSeconds, steps));
}

int run(int most, int mostDirect) {
  std::printf(
      "| bubbles | dt ms | k N/m | pcg_jacobi iterations | ms | of it set-up | pcg_ic iterations | ms | of "
      "it set-up "
      "| cholmod ms |\n|---|---|---|---|---|---|---|---|---|---|\n");
  for (int count : {100, 1000, 4000, 16000, 100000}) {
    if (count > most) break;
    const FloatingFoam foam(count, 0.4);
    const StillPool pool(foam.box);
    for (double k : {0.3, 2.0, 8.0})
      for (double dt : {1e-3, 5e-3, 20e-3}) {
        const bool small = count <= mostDirect, isOneOfAll = k == 2.0 && dt == 5e-3;
        printRow(foam, pool, k, dt, small || isOneOfAll, !small);
      }
  }
  printTolerances(std::min(most, 4000));
  printDrift(most);
  return 0;
}

}  // namespace
}  // namespace spume::foam::test

int main(int argc, char** argv) {
  return spume::foam::test::run(argc > 1 ? std::atoi(argv[1]) : 16000, argc > 2 ? std::atoi(argv[2]) : 1000);
}
