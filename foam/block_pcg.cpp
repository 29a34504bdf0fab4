#include "foam/block_pcg.h"

#include <cmath>
#include <numeric>

#include "foam/parallel.h"

namespace spume::foam {
namespace {

using Eigen::Vector4d;

/// Sum over entries first .. last - 1 of coupling x v. The last number of `v` is 0, that of the sum is not to
/// be used.
Vector4d coupled(const SweptSystem& a, std::int32_t first, std::int32_t last,
                 const std::vector<Vector4d>& v) {
  Vector4d sum = Vector4d::Zero();
  for (std::int32_t e = first; e < last; ++e) {
    const Vector4d coupling = a.coupling[e].cast<double>();
    const Vector4d& of = v[a.other[e]];
    sum += coupling.dot(of) * coupling + coupling.w() * of;
  }
  return sum;
}

Vector4d padded(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z(), 0}; }

/// Sums over the rows of each block in turn.
template <typename Value>
double sumOverBlocks(const SweptSystem& a, std::vector<double>& partial, const Value& rowValue) {
  partial.resize(a.blocks());
  forEachBlock(a, [&](std::size_t first, std::size_t last) {
    double sum = 0;
    for (std::size_t k = first; k < last; ++k) sum += rowValue(k);
    partial[first / SweptSystem::kBlockRows] = sum;
  });
  return std::accumulate(partial.begin(), partial.end(), 0.0);
}

}  // namespace

int BlockPcg::improve(const SweptSystem& a, const IncompleteCholesky& factor, const Vectors3& b, double goal,
                      int maxIterations, Vectors3& x) {
  for (auto* column : {&sum_, &residual_, &direction_, &step_, &image_}) column->resize(a.size());
  double slope = start(a, factor, b), first = residual(a, factor);
  // |r| follows the norm the iteration knows, sqrt(r . M^-1 r), closely enough to tell when to look at it.
  double scale = first / std::sqrt(slope);
  int iterations = 0;
  for (double momentum = 0; iterations < maxIterations && slope > 0; ++iterations) {
    if (scale * std::sqrt(slope) <= goal) {
      const double exact = residual(a, factor);
      if (exact <= goal) break;
      scale = exact / std::sqrt(slope);
    }
    sweepBack(a, factor, momentum);
    const double curvature = sweepForth(a, factor);
    if (!(curvature > 0)) break;  // not positive definite, or lost to round-off
    const double next = advance(a, factor, slope / curvature);
    momentum = next / slope, slope = next;
  }
  forEachIndex(a.size(), [&](std::size_t k) { x[a.order[k]] += sum_[k].head<3>(); });
  return iterations;
}

/// residual_ = C^-1 b, direction_ = 0; returns b . M^-1 b.
double BlockPcg::start(const SweptSystem& a, const IncompleteCholesky& factor, const Vectors3& b) {
  return sumOverBlocks(a, partial_, [&](std::size_t k) {
    sum_[k].setZero(), direction_[k].setZero();
    residual_[k] = factor.inverse[k].times(padded(b[a.order[k]]) +
                                           coupled(a, a.row[k].start, a.row[k].after, residual_));
    return residual_[k].dot(factor.pivot[k].times(residual_[k]));
  });
}

/// direction_ = D residual_ + momentum direction_, step_ = C^-T direction_.
void BlockPcg::sweepBack(const SweptSystem& a, const IncompleteCholesky& factor, double momentum) {
  forEachBlock(a, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = last; k-- > first;) {
      direction_[k] = factor.pivot[k].times(residual_[k]) + momentum * direction_[k];
      step_[k] = factor.inverse[k].times(direction_[k] + coupled(a, a.row[k].after, a.row[k].beyond, step_));
    }
  });
}

/// image_ = C^-1 A step_; returns step_ . A step_.
double BlockPcg::sweepForth(const SweptSystem& a, const IncompleteCholesky& factor) {
  return sumOverBlocks(a, partial_, [&](std::size_t k) {
    const SweptSystem::Row& row = a.row[k];
    const Vector4d& p = step_[k];
    // image_ holds C^-1 (A - C) step_ while the sweep runs: later rows need it so.
    image_[k] = factor.inverse[k].times(direction_[k] + factor.excess[k].times(p) -
                                        coupled(a, row.beyond, row.end, step_) +
                                        coupled(a, row.start, row.after, image_));
    return direction_[k].dot(p + image_[k]);
  });
}

/// Takes the step; returns r . M^-1 r of the new residual.
double BlockPcg::advance(const SweptSystem& a, const IncompleteCholesky& factor, double step) {
  return sumOverBlocks(a, partial_, [&](std::size_t k) {
    sum_[k] += step * step_[k];
    residual_[k] -= step * (step_[k] + image_[k]);
    return residual_[k].dot(factor.pivot[k].times(residual_[k]));
  });
}

/// |r| = |C residual_|.
double BlockPcg::residual(const SweptSystem& a, const IncompleteCholesky& factor) {
  return std::sqrt(sumOverBlocks(a, partial_, [&](std::size_t k) {
    const Vector4d r =
        factor.pivot[k].times(residual_[k]) - coupled(a, a.row[k].start, a.row[k].after, residual_);
    return r.head<3>().squaredNorm();
  }));
}

}  // namespace spume::foam
