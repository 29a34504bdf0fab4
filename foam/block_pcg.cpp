#include "foam/block_pcg.h"

#include <atomic>
#include <cmath>
#include <functional>
#include <numeric>

#include "foam/parallel.h"

namespace spume::foam {
namespace {

using Eigen::Vector4f;

/// The residual's norm is guessed from the one the iteration knows; within kNear of the goal the guess is put
/// right every kLook iterations. A look costs a third of an iteration, a guess left alone was found 1.6 times
/// too high, which cost half as many iterations again.
constexpr double kNear = 10;
constexpr int kLook = 8;

/// The slope after a step is found as a difference: below this share of the last one its digits are lost to
/// single precision. Only then has a step all but solved the system, as it does one bubble's.
constexpr double kLostSlope = 1e-5;

/// Rounding that a residual gathers, as a share of D e: measured 0.6e-7 to 1.1e-7 on froths, 2.6e-7
/// and 4.3e-7 on a stiff chain that moves as a whole. An estimate, no bound: who needs one finds the residual
/// anew.
constexpr double kRounding = 3e-7;

double sumOfProducts(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

/// Sum over entries first .. last - 1 of coupling x known. The fourth number is not to be used. What a
/// register holds beyond the last entry counts as 0; what is known of rows there is not read, as others may
/// be writing it.
inline Quad coupled(const SweptSystem::Couplings& a, std::int32_t first, std::int32_t last,
                    const Vector4f* known) {
  constexpr auto kStep = static_cast<std::int32_t>(kQuads);
  static_assert(kStep <= SweptSystem::Couplings::kPadding + 1);
  QuadLanes sum = {};
  for (std::int32_t e = first; e < last; e += kStep) {
    const QuadLanes coupling = firstQuads(loadQuads(&a.block[e]), last - e);
    const std::int32_t other[] = {a.other[e], a.other[e + (e + 1 < last)]};
    static_assert(kStep <= 2);
    const QuadLanes of = gatherQuads(known, other);
    sum += sumsOf(coupling * of) * coupling + fourthsOf(coupling) * of;
  }
  return joinQuads(sum);
}

Quad padded(const Eigen::Vector3d& v) {
  return loadQuad(
      Vector4f(static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z()), 0));
}

}  // namespace

BlockPcg::Result BlockPcg::improve(const SweptSystem& a, const IncompleteCholesky& factor,
                                   const CoarseCorrection& coarse, double goal, int maxIterations,
                                   SolveWatch& watch, Vectors3& b, Vectors3& x) {
  state_.resize(a.size()), image_.resize(a.size());
  known_.resize(2 * a.size() + 2);
  forEachIndex(known_.size(), [&](std::size_t k) { known_[k].setZero(); });
  Result result = {};
  Crew::lead(a.tasks(), [&](Crew& crew) {
    result = iterate(crew, a, factor, coarse, goal, maxIterations, watch, b, x);
  });
  const double squares = reduceIndices(
      a.size(), 0.0,
      [&](std::size_t k) {
        const Eigen::Vector4f& sum = state_[k].sum;
        const std::size_t i = a.source[k];
        x[i] += moveOf(k, loadQuad(sum), a, factor, coarse);
        if (result.reached || result.stopped) b[i] = image_[k].head<3>().cast<double>();
        return factor.scale[k].solve(sum.head<3>().cast<double>()).squaredNorm();
      },
      std::plus<>());
  result.drift = kRounding * std::sqrt(squares);
  return result;
}

/// Leaves the solution in the states' sums.
BlockPcg::Result BlockPcg::iterate(Crew& crew, const SweptSystem& a, const IncompleteCholesky& factor,
                                   const CoarseCorrection& coarse, double goal, int maxIterations,
                                   SolveWatch& watch, const Vectors3& b, const Vectors3& x) {
  startClusters(coarse, b);
  // |r| follows the norm the iteration knows closely enough to tell when to look at it.
  Norms known = start(crew, a, factor, coarse, b);
  double slope = known.slope, length = 0, momentum = 0;
  bool isLost = false;
  int iterations = 0;
  for (; iterations < maxIterations && known.slope > 0; ++iterations) {
    const double guess = known.plain * std::sqrt(slope / known.slope);
    if (watch.isDue(guess, goal) && isStopped(crew, a, factor, coarse, length, watch, x)) {
      known = look(crew, a, factor, length);
      return {iterations, known.plain <= goal, true, known.plain, 0};
    }
    if (isLost || guess <= goal || (guess <= kNear * goal && (iterations + 1) % kLook == 0)) {
      known = look(crew, a, factor, std::exchange(length, 0));
      if (known.plain <= goal) return {iterations, true, false, known.plain, 0};
      if (isLost) slope = known.slope, momentum = 0;
    }
    const double ofRows = searchBack(crew, a, factor, length, momentum);
    slope = ofRows + turnClusters(crew, coarse, momentum);
    const Found found = searchForth(crew, a, factor, coarse);
    length = 0;
    if (!(found.curvature > 0)) break;  // not positive definite, or lost to round-off
    length = slope / found.curvature;
    advanceClusters(length);
    const double next = std::max(0.0, ofRows + length * (length * found.square - 2 * found.alongResidual));
    isLost = next <= kLostSlope * slope;
    momentum = next / slope, slope = next;
  }
  if (length != 0)
    sweepForth(crew, a, [&](std::size_t, std::size_t k) { advance(k, static_cast<float>(length)); });
  return {iterations, false, false, 0, 0};
}

/// What x has gained in row k, given G^-T of what the rows' states have found for it.
Eigen::Vector3d BlockPcg::moveOf(std::size_t k, const Quad& sum, const SweptSystem& a,
                                 const IncompleteCholesky& factor, const CoarseCorrection& coarse) const {
  const std::size_t cluster = coarse.clusterOf(a.source[k]);
  Eigen::Vector3d move = factor.scale[k].matrix().transpose() * toVector(sum).head<3>().cast<double>();
  if (cluster < coarse.clusters()) move += clusters_.sum.segment<3>(3 * cluster);
  return move;
}

/// Whether the watch ends the solve, `length` along the search direction.
bool BlockPcg::isStopped(Crew& crew, const SweptSystem& a, const IncompleteCholesky& factor,
                         const CoarseCorrection& coarse, double length, const SolveWatch& watch,
                         const Vectors3& x) const {
  const std::size_t count = watch.rows.size(), tasks = crew.tasks();
  std::atomic<bool> stopped = false;
  crew.forEachTask([&](std::size_t task) {
    for (std::size_t r = task * count / tasks; r < (task + 1) * count / tasks && !stopped; ++r) {
      const std::int32_t i = watch.rows[r], k = a.placeOf(i);
      const Quad sum = loadQuad(state_[k].sum) + static_cast<float>(length) * loadQuad(state_[k].step);
      if (watch.stops(i, x[i] + moveOf(k, sum, a, factor, coarse))) stopped = true;
    }
  });
  return stopped;
}

/// Sets the residual to b less what the clusters' motions do, all else to 0. Knows no search direction yet.
BlockPcg::Norms BlockPcg::start(Crew& crew, const SweptSystem& a, const IncompleteCholesky& factor,
                                const CoarseCorrection& coarse, const Vectors3& b) {
  const bool corrects = coarse.clusters() > 0;
  sumForth<2>(crew, a, sums_, [&](std::size_t, std::size_t k, DoubleQuad* of) {
    const TriangularBlock& scale = factor.scale[k];
    const Quad image = corrects ? coarse.image(k, clusters_.known.data()) : Quad{};
    const Quad plain = padded(b[a.source[k]]) - image;
    const Quad residual = scale.times(plain - coupledWithin(a, k));
    known_[behind(k)] = toVector(-scale.transposedTimes(residual));
    state_[k] = {Vector4f::Zero(), toVector(residual), Vector4f::Zero(), Vector4f::Zero()};
    image_[k].setZero();
    addTo(of[0], plain * plain), addTo(of[1], residual * residual);
  });
  return {std::sqrt(total(0)), total(1)};
}

/// Moves the clusters so that b pulls none of them any more.
void BlockPcg::startClusters(const CoarseCorrection& coarse, const Vectors3& b) {
  const auto size = static_cast<Eigen::Index>(3 * coarse.clusters());
  coarse.sumUp(b, clusters_.pull);
  coarse.solve(clusters_.pull, clusters_.sum);
  coarse.stiffen(clusters_.sum, clusters_.image);
  clusters_.pull -= clusters_.image;
  clusters_.motion.setZero(size), clusters_.ofRows.setZero(size);
  listMotions(clusters_.sum);
}

/// As rows read them.
void BlockPcg::listMotions(const Eigen::VectorXd& motion) {
  const std::size_t count = static_cast<std::size_t>(motion.size()) / 3;
  clusters_.known.assign(count + 1, Vector4f::Zero());
  for (std::size_t c = 0; c < count; ++c)
    clusters_.known[c].head<3>() = motion.segment<3>(3 * c).cast<float>();
}

/// Adds to the search direction the motions that take from the clusters what its new part p would leave of
/// their pull. Returns that pull times those motions.
double BlockPcg::turnClusters(Crew& crew, const CoarseCorrection& coarse, double momentum) {
  if (coarse.clusters() == 0) return 0;
  clusters_.left = clusters_.pull + momentum * clusters_.ofRows;
  pullClusters(crew, coarse);
  clusters_.left -= clusters_.ofRows;
  coarse.solve(clusters_.left, clusters_.answer);
  clusters_.motion = clusters_.answer + momentum * clusters_.motion;
  listMotions(clusters_.motion);
  coarse.stiffen(clusters_.motion, clusters_.image);
  clusters_.image += clusters_.ofRows;
  return sumOfProducts(clusters_.pull, clusters_.answer);
}

/// Finds Z^T A p.
void BlockPcg::pullClusters(Crew& crew, const CoarseCorrection& coarse) {
  const std::size_t count = coarse.clusters(), tasks = crew.tasks();
  crew.forEachTask([&](std::size_t task) {
    const FlushTiny flush;
    for (std::size_t c = task * count / tasks; c < (task + 1) * count / tasks; ++c)
      clusters_.ofRows.segment<3>(3 * c) = coarse.pullOf(c, known_.data());
  });
}

/// Goes `length` along the search direction with the clusters; the rows follow in the next sweep.
void BlockPcg::advanceClusters(double length) {
  clusters_.sum += length * clusters_.motion, clusters_.pull -= length * clusters_.image;
}

/// What couplings with rows swept later bring row `k`.
inline Quad BlockPcg::coupledBack(const SweptSystem& a, std::size_t k) const {
  return coupled(a.ahead, a.row[k].ahead, a.row[k + 1].ahead, known_.data());
}

/// What couplings with rows swept earlier bring it.
inline Quad BlockPcg::coupledWithin(const SweptSystem& a, std::size_t k) const {
  return coupled(a.known, a.row[k].behind, a.row[k].beyond, known_.data());
}

/// What these and couplings with rows swept at the same time bring it.
inline Quad BlockPcg::coupledForth(const SweptSystem& a, std::size_t k) const {
  return coupled(a.known, a.row[k].behind, a.row[k + 1].behind, known_.data());
}

/// Goes `length` along the search direction.
inline void BlockPcg::advance(std::size_t k, float length) {
  State& s = state_[k];
  const Quad step = loadQuad(s.step);
  s.sum = toVector(loadQuad(s.sum) + length * step);
  s.residual = toVector(loadQuad(s.residual) - length * (step + loadQuad(image_[k])));
}

/// Goes `length` along the last search direction and turns towards the residual: finds C^T p, then p. Returns
/// r . M^-1 r of the residual there.
double BlockPcg::searchBack(Crew& crew, const SweptSystem& a, const IncompleteCholesky& factor, double length,
                            double momentum) {
  const auto stride = static_cast<float>(length), turn = static_cast<float>(momentum);
  sumBack<1>(crew, a, sums_, [&](std::size_t k, DoubleQuad* of) {
    State& s = state_[k];
    const TriangularBlock& scale = factor.scale[k];
    advance(k, stride);
    const Quad residual = loadQuad(s.residual), direction = residual + turn * loadQuad(s.direction);
    const Quad known = coupledBack(a, k);
    const Quad step = direction + scale.times(known);
    known_[k] = toVector(scale.transposedTimes(step));
    s.direction = toVector(direction), s.step = toVector(step);
    addTo(of[0], residual * residual);
  });
  return total(0);
}

/// Finds the image q of the search direction p.
BlockPcg::Found BlockPcg::searchForth(Crew& crew, const SweptSystem& a, const IncompleteCholesky& factor,
                                      const CoarseCorrection& coarse) {
  const bool corrects = coarse.clusters() > 0;
  sumForth<3>(crew, a, sums_, [&](std::size_t, std::size_t k, DoubleQuad* of) {
    const State& s = state_[k];
    const TriangularBlock& scale = factor.scale[k];
    const Quad direction = loadQuad(s.direction), step = loadQuad(s.step);
    const Quad ofClusters = corrects ? coarse.image(k, clusters_.known.data()) : Quad{};
    const Quad known = coupledForth(a, k) - ofClusters;
    const Quad image = direction + factor.excess[k].times(step) - scale.times(known);
    known_[behind(k)] = toVector(-scale.transposedTimes(image));
    image_[k] = toVector(image);
    const Quad change = step + image;
    addTo(of[0], direction * change);
    addTo(of[1], loadQuad(s.residual) * change), addTo(of[2], change * change);
  });
  return {total(0) + sumOfProducts(clusters_.motion, clusters_.image), total(1), total(2)};
}

/// The sums of all groups, in their order.
double BlockPcg::total(int which) const {
  double sum = 0;
  for (const GroupSums& group : sums_) sum += group.of[which];
  return sum;
}

/// Goes `length` along the search direction, which it forgets, and finds the norms of the residual there.
BlockPcg::Norms BlockPcg::look(Crew& crew, const SweptSystem& a, const IncompleteCholesky& factor,
                               double length) {
  sumForth<2>(crew, a, sums_, [&](std::size_t, std::size_t k, DoubleQuad* of) {
    const TriangularBlock& scale = factor.scale[k];
    advance(k, static_cast<float>(length));
    const Quad residual = loadQuad(state_[k].residual);
    known_[behind(k)] = toVector(-scale.transposedTimes(residual));
    const Eigen::Vector3d across = toVector(coupledWithin(a, k)).head<3>().cast<double>();
    const Eigen::Vector3d plain = scale.solve(toVector(residual).head<3>().cast<double>()) + across;
    image_[k].head<3>() = plain.cast<float>();
    for (int c = 0; c < 3; ++c) of[0][c] += plain[c] * plain[c];
    addTo(of[1], residual * residual);
  });
  return {std::sqrt(total(0)), total(1)};
}

}  // namespace spume::foam
