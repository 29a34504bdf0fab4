#include "foam/coarse_correction.h"

#include <tbb/parallel_for.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <utility>

#include "foam/parallel.h"

namespace spume::foam {
namespace {

/// Columns of the inverse that one task finds.
constexpr Eigen::Index kColumns = 48;
/// Of what would set clusters right if they moved alone: the factor has its own share of their motions, and
/// both together would go too far (1 instead of 0.5: 56 instead of 52 iterations).
constexpr double kShare = 0.5;

/// Whether a row's neighbours hold it more stiffly than all else does.
bool movesWithOthers(const BlockSystem& a, const SweptSystem& swept, std::size_t i) {
  return 2 * a.own[i].trace() < swept.diagonal[swept.placeOf(i)].trace();
}

SymmetricSum matrixOf(const CouplingBlock& block) {
  SymmetricSum matrix;
  matrix.add(DoubleQuad{block.along.x(), block.along.y(), block.along.z(), block.across});
  return matrix;
}

}  // namespace

void CoarseCorrection::build(const BlockSystem& a, const SweptSystem& swept, bool wanted) {
  const std::size_t n = a.size();
  clusters_ = wanted ? std::min(kMostClusters, n / kLeastRows) : 0;
  if (clusters_ < kLeastClusters) clusters_ = 0;
  start_.assign(n + 1, 0), cluster_.resize(n), isFree_.assign(n, 0);
  if (clusters_ == 0) return;
  home_.resize(n), firstRow_.resize(clusters_ + 1);
  for (std::size_t g = 0; g <= clusters_; ++g) firstRow_[g] = static_cast<std::int32_t>(firstRow(g));
  forEachIndex(n, [&](std::size_t i) {
    cluster_[i] = static_cast<std::int32_t>(i * clusters_ / n);
    isFree_[i] = movesWithOthers(a, swept, i);
  });
  forEachIndex(n, [&](std::size_t k) { start_[k] = countLinks(a, swept.source[k]); });
  std::int32_t links = 0;
  for (std::int32_t& start : start_) links += std::exchange(start, links);
  link_.resize(links), block_.resize(links);
  matrix_.resize(3 * clusters_, 3 * clusters_);
  tbb::parallel_for(std::size_t{0}, clusters_, [&](std::size_t g) { fillCluster(a, swept, g); });
  invert();
}

void CoarseCorrection::refresh(const BlockSystem& a, const SweptSystem& swept,
                               const std::vector<std::int32_t>& rows) {
  if (clusters_ == 0) return;
  for (const std::int32_t i : rows) {
    const bool isFree = movesWithOthers(a, swept, i), was = std::exchange(isFree_[i], isFree);
    const auto ignore = [](std::int32_t, const SymmetricSum&) {};
    fillRow(a, swept, i, ignore);
    if (isFree == was) continue;
    for (std::int32_t e = a.start[i]; e < a.start[i + 1]; ++e) fillRow(a, swept, a.other[e], ignore);
  }
}

/// Calls use(number, cluster, block) for the links of a row: what translations of clusters do to it.
/// Differences are taken in double precision, so that a row within its cluster is left with its own block.
template <typename Use>
void CoarseCorrection::forEachLink(const BlockSystem& a, std::size_t i, const Use& use) const {
  const std::int32_t home = cluster_[i];
  SymmetricSum own, sum;
  if (isFree_[i]) own = SymmetricSum(a.own[i]);
  std::int32_t number = 1, running = home;
  for (std::int32_t e = a.start[i]; e < a.start[i + 1]; ++e) {
    const std::int32_t j = a.other[e];
    const bool isHome = isIn(home, j);
    if (isHome && isFree_[i] == isFree_[j]) continue;
    const SymmetricSum block = matrixOf(a.block[e]);
    if (isHome) {
      own.add(isFree_[i] - isFree_[j], block);
      continue;
    }
    const std::int32_t c = cluster_[j];
    if (c != running && running != home) use(number++, running, sum);
    if (c != running) running = c, sum = {};
    own.add(isFree_[i], block), sum.add(-isFree_[j], block);
  }
  if (running != home) use(number, running, sum);
  use(0, home, own);
}

std::int32_t CoarseCorrection::countLinks(const BlockSystem& a, std::size_t i) const {
  const std::int32_t home = cluster_[i];
  std::int32_t count = 1, running = home;
  for (std::int32_t e = a.start[i]; e < a.start[i + 1]; ++e) {
    if (isIn(home, a.other[e])) continue;
    const std::int32_t c = cluster_[a.other[e]];
    if (c != running) ++count, running = c;
  }
  return count;
}

/// Also calls use(cluster, block) for each link.
template <typename Use>
void CoarseCorrection::fillRow(const BlockSystem& a, const SweptSystem& swept, std::size_t i,
                               const Use& use) {
  const std::int32_t k = swept.placeOf(i);
  home_[k] = static_cast<std::int32_t>(clusterOf(i));
  forEachLink(a, i, [&](std::int32_t number, std::int32_t c, const SymmetricSum& block) {
    link_[start_[k] + number] = c, block_[start_[k] + number] = SymmetricBlock(block);
    use(c, block);
  });
}

/// Its rows, and its columns of Z^T A Z; those of a cluster in which nothing is free stand apart.
void CoarseCorrection::fillCluster(const BlockSystem& a, const SweptSystem& swept, std::size_t g) {
  auto columns = matrix_.middleCols<3>(static_cast<Eigen::Index>(3 * g));
  columns.setZero();
  for (std::size_t i = firstRow(g); i < firstRow(g + 1); ++i)
    fillRow(a, swept, i, [&](std::int32_t c, const SymmetricSum& block) {
      if (isFree_[i]) columns.middleRows<3>(3 * c) += block.matrix();
    });
  auto own = columns.middleRows<3>(static_cast<Eigen::Index>(3 * g));
  if (own.isZero(0)) own.setIdentity();
}

/// Where round-off leaves no inverse, there is no correction. Only the lower half is found: from a column's
/// diagonal down it depends on nothing above, which saves two thirds of the work.
void CoarseCorrection::invert() {
  const Eigen::Index size = matrix_.rows();
  inverse_.setZero(size, size);
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> cholesky(matrix_);
  if (cholesky.info() != Eigen::Success) return;
  tbb::parallel_for(Eigen::Index{0}, (size + kColumns - 1) / kColumns, [&](Eigen::Index task) {
    const Eigen::Index first = kColumns * task, rest = size - first;
    const auto factor = matrix_.bottomRightCorner(rest, rest).triangularView<Eigen::Lower>();
    auto columns = inverse_.block(first, first, rest, std::min(kColumns, rest));
    columns.diagonal().setConstant(kShare);
    factor.solveInPlace(columns);
    factor.transpose().solveInPlace(columns);
  });
}

void CoarseCorrection::sumUp(const Vectors3& b, Eigen::VectorXd& sums) const {
  sums.resize(3 * clusters_);
  tbb::parallel_for(std::size_t{0}, clusters_, [&](std::size_t g) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t i = firstRow(g); i < firstRow(g + 1); ++i)
      if (isFree_[i]) sum += b[i];
    sums.segment<3>(3 * g) = sum;
  });
}

void CoarseCorrection::solve(const Eigen::VectorXd& sums, Eigen::VectorXd& motion) const {
  motion.noalias() = inverse_.selfadjointView<Eigen::Lower>() * sums;
}

}  // namespace spume::foam
