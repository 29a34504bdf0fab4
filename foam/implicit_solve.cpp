#include "foam/implicit_solve.h"

#include <tbb/parallel_invoke.h>

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

double ImplicitSolve::begin(const BlockSystem& a, const Vectors3& b, const Vectors3& x) {
  isLaidOut_ = false;
  findResidual(a, b, x);
  return norm_;
}

double ImplicitSolve::begin(const BlockSystem& a, const Vectors3& b, const Vectors3& x,
                            const std::vector<std::int32_t>& rows) {
  isLaidOut_ = false;
  residual_ = b, drift_ = 0;
  findResidualAround(a, b, x, rows);
  return norm_;
}

double ImplicitSolve::follow(const BlockSystem& a, const Vectors3& b, const Vectors3& x,
                             const std::vector<std::int32_t>& rows) {
  if (rows.empty()) return norm_;
  findResidualAround(a, b, x, rows);
  if (!isLaidOut_) return norm_;
  cholesky_.refresh(swept_, swept_.refresh(a, rows));
  coarse_.refresh(a, swept_, rows);
  return norm_;
}

void ImplicitSolve::findResidual(const BlockSystem& a, const Vectors3& b, const Vectors3& x) {
  residual_.resize(a.size());
  forEachIndex(a.size(), [&](std::size_t i) { residual_[i] = b[i] - a.row(i, x); });
  norm_ = lengthOf(residual_), drift_ = 0;
}

/// Of `rows` and their neighbours: a row's residual depends on its neighbours' x.
void ImplicitSolve::findResidualAround(const BlockSystem& a, const Vectors3& b, const Vectors3& x,
                                       const std::vector<std::int32_t>& rows) {
  isStale_.assign(a.size(), 0), stale_.clear();
  const auto add = [&](std::int32_t i) {
    if (!std::exchange(isStale_[i], 1)) stale_.push_back(i);
  };
  for (const std::int32_t i : rows) {
    add(i);
    for (std::int32_t e = a.start[i]; e < a.start[i + 1]; ++e) add(a.other[e]);
  }
  forEachIndex(stale_.size(), [&](std::size_t k) {
    const auto i = static_cast<std::size_t>(stale_[k]);
    residual_[i] = b[i] - a.row(i, x);
  });
  norm_ = lengthOf(residual_);
}

double ImplicitSolve::roundOff(const BlockSystem& a, const Vectors3& x) {
  return kRoundOff *
         std::sqrt(reduceIndices(
             a.size(), 0.0, [&](std::size_t i) { return (a.diagonal(i).norm() * x[i]).squaredNorm(); },
             std::plus<>()));
}

SolveReport ImplicitSolve::solve(const BlockSystem& a, const Vectors3& b, double goal, int maxIterations,
                                 Vectors3& x) {
  SolveWatch none;
  return solve(a, b, goal, maxIterations, x, none);
}

SolveReport ImplicitSolve::solve(const BlockSystem& a, const Vectors3& b, double goal, int maxIterations,
                                 Vectors3& x, SolveWatch& watch) {
  if (norm_ <= goal && drift_ > 0) findResidual(a, b, x);
  const double first = norm_;
  SolveReport report;
  report.converged = first <= goal;
  if (report.converged) return report;
  const bool iterative = solver_ != LinearSolver::cholmod;
  if (iterative) iterate(a, b, goal, maxIterations, watch, x, report);
  const auto reached = [&] {
    return norm_ <= goal || norm_ <= std::min(roundOff(a, x), kLargestRoundOff * lengthOf(b));
  };
  if (!report.stopped && !reached()) report.fellBack = solveDirectly(a, b, goal, x) && iterative;
  report.residual = norm_ / first;
  report.converged = !report.stopped && reached();
  return report;
}

void ImplicitSolve::iterate(const BlockSystem& a, const Vectors3& b, double goal, int maxIterations,
                            SolveWatch& watch, Vectors3& x, SolveReport& report) {
  if (!std::exchange(isLaidOut_, true)) {
    const bool factors = solver_ == LinearSolver::pcgIncompleteCholesky;
    swept_.copy(a, factors);
    coarse_.build(a, swept_, factors);
    const auto factorRows = [&] {
      Crew::lead(swept_.tasks(), [&](Crew& crew) { cholesky_.factor(crew, swept_); });
    };
    tbb::parallel_invoke(factorRows, [&] { coarse_.factor(); });
  }
  for (int pass = 0; pass < kRefinements && norm_ > goal && report.iterations < maxIterations; ++pass) {
    const double last = norm_, aim = std::max(kAim * goal, kSinglePrecision * last);
    const BlockPcg::Result done =
        pcg_.improve(swept_, cholesky_, coarse_, aim, maxIterations - report.iterations, watch, residual_, x);
    report.iterations += done.iterations, report.stopped = done.stopped;
    drift_ += done.drift;
    if (done.stopped && drift_ <= watch.allowed)
      norm_ = done.norm;
    else
      findResidual(a, b, x);
    if (done.stopped || norm_ > kStalled * last) break;
  }
}

/// From the residual as it is.
bool ImplicitSolve::solveDirectly(const BlockSystem& a, const Vectors3& b, double goal, Vectors3& x) {
  if (!direct_.factor(a)) return false;
  for (int pass = 0; pass < kRefinements && norm_ > goal; ++pass) {
    direct_.improve(residual_, x);
    const double last = norm_;
    findResidual(a, b, x);
    if (norm_ > kStalled * last) break;
  }
  return true;
}

void ImplicitSolve::balance(const BlockSystem& a, Vectors3& x) const {
  const auto add = [](const auto& p, const auto& q) { return (p + q).eval(); };
  const Eigen::Vector3d left = reduceIndices(
      x.size(), Eigen::Vector3d::Zero().eval(), [&](std::size_t i) { return residual_[i]; }, add);
  const Eigen::Matrix3d stiffness = reduceIndices(
      x.size(), Eigen::Matrix3d::Zero().eval(), [&](std::size_t i) { return a.own[i]; }, add);
  const Eigen::Vector3d shift = stiffness.inverse() * left;
  forEachIndex(x.size(), [&](std::size_t i) { x[i] += shift; });
}

}  // namespace spume::foam
