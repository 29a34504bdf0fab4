#include "foam/block_pcg.h"

#include <cmath>
#include <cstring>
#include <numeric>

#include "foam/parallel.h"

namespace spume::foam {
namespace {

using Eigen::Vector4d;

/// The residual's norm is guessed from the one the iteration knows; within kNear of the goal the guess is put
/// right every kLook iterations. A look costs half an iteration, a guess left alone was found 1.6 times too
/// high, which cost half as many iterations again.
constexpr double kNear = 10;
constexpr int kLook = 8;

/// Partial sums of threads stand a cache line apart.
constexpr std::size_t kSumStride = 8;

using Four [[gnu::vector_size(4 * sizeof(double))]] = double;
using FourFloats [[gnu::vector_size(4 * sizeof(float))]] = float;

template <typename To, typename From>
inline To loadAs(const From* from) {
  To to;
  std::memcpy(&to, from, sizeof to);
  return to;
}

/// coupling x v. The last number of v is 0, that of the result is not to be used.
inline Four coupledOne(const SweptSystem& a, std::int32_t e, const Vector4d* known) {
  const Four coupling = __builtin_convertvector(loadAs<FourFloats>(a.coupling[e].data()), Four);
  const Four of = loadAs<Four>(known + a.other[e]);
  Four dot = coupling * of;
  dot += __builtin_shufflevector(dot, dot, 1, 0, 3, 2);
  dot += __builtin_shufflevector(dot, dot, 2, 3, 0, 1);
  return dot * coupling + __builtin_shufflevector(coupling, coupling, 3, 3, 3, 3) * of;
}

/// Sum over entries first .. last - 1 of coupling x known; see coupledOne.
inline Vector4d coupled(const SweptSystem& a, std::int32_t first, std::int32_t last, const Vector4d* known) {
  static_assert(SweptSystem::kRun == 4);
  Four sum[4] = {};
  for (std::int32_t e = first; e < last; e += 4)
    for (int k = 0; k < 4; ++k) sum[k] += coupledOne(a, e + k, known);
  const Four all = (sum[0] + sum[1]) + (sum[2] + sum[3]);
  Vector4d out;
  std::memcpy(out.data(), &all, sizeof all);
  return out;
}

Vector4d padded(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z(), 0}; }

/// Sums over the rows, in the order of sweepForth.
template <typename Value>
double sumForth(const SweptSystem& a, std::vector<double>& partial, const Value& rowValue) {
  partial.assign(kSumStride * a.groups(), 0.0);
  sweepForth(a, [&](std::size_t group, std::size_t k) { partial[kSumStride * group] += rowValue(k); });
  return std::accumulate(partial.begin(), partial.end(), 0.0);
}

}  // namespace

int BlockPcg::improve(const SweptSystem& a, const IncompleteCholesky& factor, const Vectors3& b, double goal,
                      int maxIterations, Vectors3& x) {
  for (auto* column : {&sum_, &residual_, &direction_}) column->resize(a.size());
  known_.assign(2 * a.size() + 2, Vector4d::Zero());
  double slope = start(a, factor, b), first = residual(a, factor);
  // |r| follows the norm the iteration knows, sqrt(r . M^-1 r), closely enough to tell when to look at it.
  double scale = first / std::sqrt(slope);
  int iterations = 0;
  for (double momentum = 0; iterations < maxIterations && slope > 0; ++iterations) {
    const double guess = scale * std::sqrt(slope);
    if (guess <= goal || (guess <= kNear * goal && iterations % kLook == 0)) {
      const double exact = residual(a, factor);
      if (exact <= goal) break;
      scale = exact / std::sqrt(slope);
    }
    searchBack(a, factor, momentum);
    const double curvature = searchForth(a, factor);
    if (!(curvature > 0)) break;  // not positive definite, or lost to round-off
    const double next = advance(a, factor, slope / curvature);
    momentum = next / slope, slope = next;
  }
  forEachIndex(a.size(), [&](std::size_t k) { x[k] += sum_[k].head<3>(); });
  return iterations;
}

/// residual_ = C^-1 b, direction_ = 0; returns b . M^-1 b. Knows no search direction yet.
double BlockPcg::start(const SweptSystem& a, const IncompleteCholesky& factor, const Vectors3& b) {
  return sumForth(a, partial_, [&](std::size_t k) {
    sum_[k].setZero(), direction_[k].setZero();
    const Vector4d known = coupled(a, a.row[k].behind, a.row[k].end, known_.data());
    residual_[k] = factor.inverse[k].times(padded(b[k]) - known);
    known_[behind(k)] = -residual_[k];
    return residual_[k].dot(factor.pivot[k].times(residual_[k]));
  });
}

/// direction_ = D residual_ + momentum direction_; the search direction is C^-T direction_.
void BlockPcg::searchBack(const SweptSystem& a, const IncompleteCholesky& factor, double momentum) {
  sweepBack(a, [&](std::size_t, std::size_t k) {
    direction_[k] = factor.pivot[k].times(residual_[k]) + momentum * direction_[k];
    const Vector4d known = coupled(a, a.row[k].ahead, a.row[k].behind, known_.data());
    known_[k] = factor.inverse[k].times(direction_[k] + known);
  });
}

/// Finds the image of the search direction p; returns p . A p.
double BlockPcg::searchForth(const SweptSystem& a, const IncompleteCholesky& factor) {
  return sumForth(a, partial_, [&](std::size_t k) {
    const Vector4d& p = stepOf(k);
    // C^-1 (A - C) p while the sweep runs: later rows need it so.
    const Vector4d known = coupled(a, a.row[k].behind, a.row[k].end, known_.data());
    const Vector4d image = factor.inverse[k].times(direction_[k] + factor.excess[k].times(p) - known);
    known_[behind(k)] = -image;
    return direction_[k].dot(p + image);
  });
}

/// Takes the step; returns r . M^-1 r of the new residual.
double BlockPcg::advance(const SweptSystem& a, const IncompleteCholesky& factor, double step) {
  return sumForth(a, partial_, [&](std::size_t k) {
    sum_[k] += step * stepOf(k);
    residual_[k] -= step * (stepOf(k) - known_[behind(k)]);
    return residual_[k].dot(factor.pivot[k].times(residual_[k]));
  });
}

/// |r| = |C residual_|; forgets the search direction.
double BlockPcg::residual(const SweptSystem& a, const IncompleteCholesky& factor) {
  forEachIndex(a.size(), [&](std::size_t k) { known_[k].setZero(), known_[behind(k)] = -residual_[k]; });
  return std::sqrt(sumForth(a, partial_, [&](std::size_t k) {
    const Vector4d known = coupled(a, a.row[k].behind, a.row[k].end, known_.data());
    return (factor.pivot[k].times(residual_[k]) + known).head<3>().squaredNorm();
  }));
}

}  // namespace spume::foam
