#include "foam/implicit_solve.h"

#include <Eigen/LU>
#include <cmath>

#include "foam/parallel.h"

namespace spume::foam {
namespace {

double dot(const Vectors3& a, const Vectors3& b) {
  return reduceIndices(
      a.size(), 0.0, [&](std::size_t i) { return a[i].dot(b[i]); }, std::plus<>());
}

}  // namespace

void ImplicitSolve::prepare(const BlockSystem& a) {
  const std::size_t n = a.size();
  inverse_.resize(n), direction_.resize(n), image_.resize(n), preconditioned_.resize(n);
  forEachIndex(n, [&](std::size_t i) { inverse_[i] = a.diagonal(i).inverse(); });
}

double ImplicitSolve::residual(const BlockSystem& a, const Vectors3& b, const Vectors3& x) {
  residual_.resize(a.size());
  forEachIndex(a.size(), [&](std::size_t i) { residual_[i] = b[i] - a.row(i, x); });
  return std::sqrt(dot(residual_, residual_));
}

SolveReport ImplicitSolve::solve(const BlockSystem& a, const Vectors3& b, double goal, int maxIterations,
                                 Vectors3& x) {
  const std::size_t n = a.size();
  const double first = residual(a, b, x);
  double norm = first;
  SolveReport report;
  report.converged = norm <= goal;
  if (report.converged) return report;
  prepare(a);
  const auto precondition = [&](std::size_t i) { preconditioned_[i] = inverse_[i] * residual_[i]; };
  forEachIndex(n, precondition);
  direction_ = preconditioned_;
  double slope = dot(residual_, preconditioned_);
  while (norm > goal && report.iterations < maxIterations) {
    forEachIndex(n, [&](std::size_t i) { image_[i] = a.row(i, direction_); });
    const double step = slope / dot(direction_, image_);
    forEachIndex(n, [&](std::size_t i) {
      x[i] += step * direction_[i];
      residual_[i] -= step * image_[i];
      precondition(i);
    });
    const double next = dot(residual_, preconditioned_);
    forEachIndex(n,
                 [&](std::size_t i) { direction_[i] = preconditioned_[i] + next / slope * direction_[i]; });
    slope = next;
    norm = std::sqrt(dot(residual_, residual_));
    ++report.iterations;
  }
  report.residual = norm / first;
  report.converged = norm <= goal;
  residual(a, b, x);
  shiftRigidly(a, x);
  return report;
}

void ImplicitSolve::shiftRigidly(const BlockSystem& a, Vectors3& x) {
  const auto add = [](const auto& p, const auto& q) { return (p + q).eval(); };
  const Eigen::Vector3d left = reduceIndices(
      x.size(), Eigen::Vector3d::Zero().eval(), [&](std::size_t i) { return residual_[i]; }, add);
  const Eigen::Matrix3d stiffness = reduceIndices(
      x.size(), Eigen::Matrix3d::Zero().eval(), [&](std::size_t i) { return a.own[i]; }, add);
  const Eigen::Vector3d shift = stiffness.inverse() * left;
  forEachIndex(x.size(), [&](std::size_t i) { x[i] += shift; });
}

}  // namespace spume::foam
