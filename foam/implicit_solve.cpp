#include "foam/implicit_solve.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "foam/parallel.h"

namespace spume::foam {
namespace {

/// Passes of refinement: the iteration works in single precision, the direct solver's factor loses digits to
/// conditioning. Each pass gains several digits; tolerances of 1e-12 are reached before the last.
constexpr int kRefinements = 5;
/// The iteration aims a little below the goal, and no further below the residual than single precision
/// carries.
constexpr double kAim = 0.9, kSinglePrecision = 1e-7;
/// A pass that does not bring the residual below this share of the last has met round-off.
constexpr double kStalled = 0.5;
/// A residual that rounding keeps above the goal is taken up to this share of the right-hand side.
constexpr double kLargestRoundOff = 1e-4;
/// Rounding of a row's sum, in units of its largest term: a dozen operations of half an ulp each.
constexpr double kRoundOff = 16 * std::numeric_limits<double>::epsilon();

double lengthOf(const Vectors3& v) {
  return std::sqrt(reduceIndices(
      v.size(), 0.0, [&](std::size_t i) { return v[i].squaredNorm(); }, std::plus<>()));
}

}  // namespace

double ImplicitSolve::residual(const BlockSystem& a, const Vectors3& b, const Vectors3& x) {
  residual_.resize(a.size());
  forEachIndex(a.size(), [&](std::size_t i) { residual_[i] = b[i] - a.row(i, x); });
  return std::sqrt(reduceIndices(
      a.size(), 0.0, [&](std::size_t i) { return residual_[i].squaredNorm(); }, std::plus<>()));
}

double ImplicitSolve::roundOff(const BlockSystem& a, const Vectors3& x) {
  return kRoundOff *
         std::sqrt(reduceIndices(
             a.size(), 0.0, [&](std::size_t i) { return (a.diagonal(i).norm() * x[i]).squaredNorm(); },
             std::plus<>()));
}

SolveReport ImplicitSolve::solve(const BlockSystem& a, const Vectors3& b, double goal, int maxIterations,
                                 Vectors3& x) {
  couplingsKnown_ = false;
  return solveAgain(a, b, goal, maxIterations, x);
}

SolveReport ImplicitSolve::solveAgain(const BlockSystem& a, const Vectors3& b, double goal, int maxIterations,
                                      Vectors3& x) {
  const double first = residual(a, b, x);
  SolveReport report;
  report.converged = first <= goal;
  if (report.converged) return report;
  const bool iterative = solver_ != LinearSolver::cholmod;
  double norm = first;
  if (iterative) report.iterations = iterate(a, b, goal, maxIterations, norm, x);
  const auto reached = [&] {
    return norm <= goal || norm <= std::min(roundOff(a, x), kLargestRoundOff * lengthOf(b));
  };
  if (!reached()) {
    report.fellBack = solveDirectly(a, b, goal, x) && iterative;
    norm = residual(a, b, x);
  }
  report.residual = norm / first;
  report.converged = reached();
  return report;
}

/// Starts from the residual in residual_, of length `norm`, and leaves that it ends with there.
int ImplicitSolve::iterate(const BlockSystem& a, const Vectors3& b, double goal, int maxIterations,
                           double& norm, Vectors3& x) {
  if (std::exchange(couplingsKnown_, true)) {
    swept_.refresh(a), cholesky_.refresh(swept_);
  } else {
    swept_.copy(a, solver_ == LinearSolver::pcgIncompleteCholesky);
    Crew::lead(swept_.groups(), [&](Crew& crew) { cholesky_.factor(crew, swept_); });
  }
  int iterations = 0;
  for (int pass = 0; pass < kRefinements && norm > goal && iterations < maxIterations; ++pass) {
    const double aim = std::max(kAim * goal, kSinglePrecision * norm);
    iterations += pcg_.improve(swept_, cholesky_, residual_, norm, aim, maxIterations - iterations, x);
    const double last = std::exchange(norm, residual(a, b, x));
    if (norm > kStalled * last) break;
  }
  return iterations;
}

bool ImplicitSolve::solveDirectly(const BlockSystem& a, const Vectors3& b, double goal, Vectors3& x) {
  if (!direct_.factor(a)) return false;
  double norm = residual(a, b, x);
  for (int pass = 0; pass < kRefinements && norm > goal; ++pass) {
    direct_.improve(residual_, x);
    const double last = std::exchange(norm, residual(a, b, x));
    if (norm > kStalled * last) break;
  }
  return true;
}

void ImplicitSolve::balance(const BlockSystem& a, const Vectors3& b, Vectors3& x) {
  residual(a, b, x);
  const auto add = [](const auto& p, const auto& q) { return (p + q).eval(); };
  const Eigen::Vector3d left = reduceIndices(
      x.size(), Eigen::Vector3d::Zero().eval(), [&](std::size_t i) { return residual_[i]; }, add);
  const Eigen::Matrix3d stiffness = reduceIndices(
      x.size(), Eigen::Matrix3d::Zero().eval(), [&](std::size_t i) { return a.own[i]; }, add);
  const Eigen::Vector3d shift = stiffness.inverse() * left;
  forEachIndex(x.size(), [&](std::size_t i) { x[i] += shift; });
}

}  // namespace spume::foam
