#include "foam/coarse_correction.h"

#include <tbb/parallel_for.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <utility>

#include "foam/parallel.h"

namespace spume::foam {
namespace {

/// Columns of the inverse that one task finds.
constexpr std::size_t kColumns = 48;
/// Of what would set clusters right if they moved alone: the factor has its own share of their motions, and
/// both together would go too far (1 instead of 0.5: 56 instead of 52 iterations).
constexpr double kShare = 0.5;

/// Whether a row's neighbours hold it more stiffly than all else does.
bool movesWithOthers(const BlockSystem& a, std::size_t i) {
  double couplings = 0;
  for (std::int32_t e = a.start[i]; e < a.start[i + 1]; ++e)
    couplings += a.block[e].along.squaredNorm() + 3 * a.block[e].across;
  return a.own[i].trace() < couplings;
}

Eigen::Matrix3d matrixOf(const CouplingBlock& block) {
  return block.along * block.along.transpose() + block.across * Eigen::Matrix3d::Identity();
}

}  // namespace

void CoarseCorrection::build(const BlockSystem& a, const SweptSystem& swept, bool wanted) {
  const std::size_t n = a.size();
  clusters_ = wanted ? std::min(kMostClusters, n / kLeastRows) : 0;
  if (clusters_ < kLeastClusters) clusters_ = 0;
  start_.assign(n + 1, 0), cluster_.resize(n), isFree_.assign(n, 0);
  if (clusters_ == 0) return;
  home_.resize(n);
  forEachIndex(n, [&](std::size_t i) {
    cluster_[i] = static_cast<std::int32_t>(i * clusters_ / n);
    isFree_[i] = movesWithOthers(a, i);
  });
  forEachIndex(n, [&](std::size_t k) { start_[k] = countLinks(a, swept.source[k]); });
  std::int32_t links = 0;
  for (std::int32_t& start : start_) links += std::exchange(start, links);
  link_.resize(links), block_.resize(links);
  forEachIndex(n, [&](std::size_t i) { fillRow(a, swept, i); });
  invert(a);
}

void CoarseCorrection::refresh(const BlockSystem& a, const SweptSystem& swept,
                               const std::vector<std::int32_t>& rows) {
  if (clusters_ == 0) return;
  for (const std::int32_t i : rows) {
    const bool isFree = movesWithOthers(a, i), was = std::exchange(isFree_[i], isFree);
    fillRow(a, swept, i);
    if (isFree == was) continue;
    for (std::int32_t e = a.start[i]; e < a.start[i + 1]; ++e) fillRow(a, swept, a.other[e]);
  }
}

/// Calls use(number, cluster, block) for the links of a row: what translations of clusters do to it.
/// Differences are taken in double precision, so that a row within its cluster is left with its own block.
template <typename Use>
void CoarseCorrection::forEachLink(const BlockSystem& a, std::size_t i, const Use& use) const {
  const std::int32_t home = cluster_[i];
  Eigen::Matrix3d own = Eigen::Matrix3d::Zero(), sum = Eigen::Matrix3d::Zero();
  if (isFree_[i]) own = a.own[i];
  std::int32_t number = 1, running = home;
  for (std::int32_t e = a.start[i]; e < a.start[i + 1]; ++e) {
    const std::int32_t j = a.other[e], c = cluster_[j];
    const Eigen::Matrix3d block = matrixOf(a.block[e]);
    if (c == home) {
      own += (isFree_[i] - isFree_[j]) * block;
      continue;
    }
    if (c != running && running != home) use(number++, running, sum);
    if (c != running) running = c, sum.setZero();
    own += isFree_[i] * block, sum -= isFree_[j] * block;
  }
  if (running != home) use(number, running, sum);
  use(0, home, own);
}

std::int32_t CoarseCorrection::countLinks(const BlockSystem& a, std::size_t i) const {
  std::int32_t count = 1, running = cluster_[i];
  for (std::int32_t e = a.start[i]; e < a.start[i + 1]; ++e) {
    const std::int32_t c = cluster_[a.other[e]];
    if (c != cluster_[i] && c != running) ++count, running = c;
  }
  return count;
}

void CoarseCorrection::fillRow(const BlockSystem& a, const SweptSystem& swept, std::size_t i) {
  const std::int32_t k = swept.placeOf(i);
  home_[k] = static_cast<std::int32_t>(clusterOf(i));
  forEachLink(a, i, [&](std::int32_t number, std::int32_t c, const Eigen::Matrix3d& block) {
    link_[start_[k] + number] = c, block_[start_[k] + number] = SymmetricBlock(block);
  });
}

/// A cluster in which nothing is free stands apart. Where round-off leaves no inverse, there is no
/// correction.
void CoarseCorrection::invert(const BlockSystem& a) {
  const std::size_t size = 3 * clusters_, n = a.size();
  matrix_.setZero(size, size);
  tbb::parallel_for(std::size_t{0}, clusters_, [&](std::size_t g) {
    for (std::size_t i = (g * n + clusters_ - 1) / clusters_; i * clusters_ < (g + 1) * n; ++i)
      if (isFree_[i])
        forEachLink(a, i, [&](std::int32_t, std::int32_t c, const Eigen::Matrix3d& block) {
          matrix_.block<3, 3>(3 * c, 3 * g) += block;
        });
    if (matrix_.block<3, 3>(3 * g, 3 * g).isZero(0)) matrix_.block<3, 3>(3 * g, 3 * g).setIdentity();
  });
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> cholesky(matrix_);
  if (cholesky.info() != Eigen::Success) {
    inverse_.setZero(size, size);
    return;
  }
  inverse_.setIdentity(size, size);
  tbb::parallel_for(std::size_t{0}, (size + kColumns - 1) / kColumns, [&](std::size_t task) {
    auto columns = inverse_.middleCols(kColumns * task, std::min(kColumns, size - kColumns * task));
    cholesky.solveInPlace(columns);
    columns *= kShare;
  });
}

void CoarseCorrection::sumUp(const Vectors3& b, Eigen::VectorXd& sums) const {
  const std::size_t n = b.size();
  sums.setZero(3 * clusters_);
  tbb::parallel_for(std::size_t{0}, clusters_, [&](std::size_t g) {
    for (std::size_t i = (g * n + clusters_ - 1) / clusters_; i * clusters_ < (g + 1) * n; ++i)
      if (isFree_[i]) sums.segment<3>(3 * g) += b[i];
  });
}

void CoarseCorrection::solve(const Eigen::VectorXd& sums, Eigen::VectorXd& motion) const {
  motion.noalias() = inverse_ * sums;
}

}  // namespace spume::foam
