#include "foam/coarse_correction.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "foam/parallel.h"

namespace spume::foam {
namespace {

/// Links behind the last, for whole registers to read.
constexpr std::int32_t kPadding = 1;
/// Rows changed, as a share of all, from which on the clusters' matrix is factored anew.
constexpr double kManyChanges = 1e-3;

/// Whether a row's neighbours hold it more stiffly than all else does.
bool movesWithOthers(const BlockSystem& a, const SweptSystem& swept, std::size_t i) {
  return 2 * a.own[i].trace() < swept.diagonal[swept.placeOf(i)].trace();
}

SymmetricSum matrixOf(const CouplingBlock& block) {
  SymmetricSum matrix;
  matrix.add(block.number);
  return matrix;
}

}  // namespace

void CoarseCorrection::build(const BlockSystem& a, const SweptSystem& swept, bool wanted) {
  const std::size_t n = a.size();
  clusters_ = wanted ? std::min(kMostClusters, n / kLeastRows) : 0;
  if (clusters_ < kLeastClusters) clusters_ = 0;
  cluster_.resize(n), isFree_.assign(n, 0);
  if (clusters_ == 0) return forgetMatrix();
  firstRow_.resize(clusters_ + 1);
  for (std::size_t g = 0; g <= clusters_; ++g) firstRow_[g] = static_cast<std::int32_t>(firstRow(g));
  forEachIndex(n, [&](std::size_t i) {
    cluster_[i] = static_cast<std::int32_t>(i * clusters_ / n);
    isFree_[i] = movesWithOthers(a, swept, i);
  });
  findPattern(a, swept);
  tbb::parallel_for(std::size_t{0}, clusters_, [&](std::size_t g) {
    for (std::int32_t i = firstRow_[g]; i < firstRow_[g + 1]; ++i) fillRow(a, swept, i);
    sumCluster(swept, g);
  });
}

/// That of a system with clusters, which the last one may have been.
void CoarseCorrection::forgetMatrix() {
  matrix_ = {};
  factor_.order(matrix_);
}

/// What a translation does to a row depends on which of its neighbours are free.
void CoarseCorrection::refresh(const BlockSystem& a, const SweptSystem& swept,
                               const std::vector<std::int32_t>& rows) {
  if (clusters_ == 0 || rows.empty()) return;
  isStale_.assign(a.size(), 0), staleCluster_.assign(clusters_, 0), stale_.clear();
  const auto note = [&](std::int32_t i) {
    if (!std::exchange(isStale_[i], 1)) stale_.push_back(i), staleCluster_[cluster_[i]] = 1;
  };
  for (const std::int32_t i : rows) {
    note(i);
    const bool isFree = movesWithOthers(a, swept, i);
    if (isFree != std::exchange(isFree_[i], isFree))
      for (std::int32_t e = a.start[i]; e < a.start[i + 1]; ++e) note(a.other[e]);
  }
  forEachIndex(stale_.size(), [&](std::size_t s) { fillRow(a, swept, stale_[s]); });
  tbb::parallel_for(std::size_t{0}, clusters_, [&](std::size_t g) {
    if (staleCluster_[g]) sumCluster(swept, g);
  });
  if (static_cast<double>(rows.size()) > kManyChanges * static_cast<double>(a.size())) factor();
}

/// Calls use(number, block) for the links of a row: what translations of clusters do to it.
/// Differences are taken in double precision, so that a row within its cluster is left with its own block.
template <typename Use>
void CoarseCorrection::forEachLink(const BlockSystem& a, std::size_t i, const Use& use) const {
  const std::int32_t home = cluster_[i], first = firstRow_[home], end = firstRow_[home + 1];
  SymmetricSum own, sum;
  if (isFree_[i]) own = SymmetricSum(a.own[i]);
  std::int32_t number = 1, running = home;
  for (std::int32_t e = a.start[i]; e < a.start[i + 1]; ++e) {
    const std::int32_t j = a.other[e];
    const bool isHome = j >= first && j < end;
    if (isHome && isFree_[i] == isFree_[j]) continue;
    const SymmetricSum block = matrixOf(a.block[e]);
    if (isHome) {
      own.add(isFree_[i] - isFree_[j], block);
      continue;
    }
    const std::int32_t c = cluster_[j];
    if (c != running && running != home) use(number++, sum);
    if (c != running) running = c, sum = {};
    own.add(isFree_[i], block), sum.add(-isFree_[j], block);
  }
  if (running != home) use(number, sum);
  use(0, own);
}

/// How many clusters a row knows, its own among them. Neighbours come in the order of their numbers, and so
/// of their clusters. Without branches, which nothing could foretell.
std::int32_t CoarseCorrection::countLinks(const BlockSystem& a, std::size_t i) const {
  std::int32_t count = 1, running = -1;
  for (std::int32_t e = a.start[i]; e < a.start[i + 1]; ++e) {
    const std::int32_t c = cluster_[a.other[e]];
    count += (c != running) & (c != cluster_[i]);
    running = c;
  }
  return count;
}

/// Which they are, its own first.
void CoarseCorrection::listLinks(const BlockSystem& a, std::size_t i, std::int32_t* list) const {
  const std::int32_t home = cluster_[i], first = firstRow_[home], end = firstRow_[home + 1];
  std::int32_t running = home;
  *list++ = home;
  for (std::int32_t e = a.start[i]; e < a.start[i + 1]; ++e) {
    const std::int32_t j = a.other[e];
    if (j >= first && j < end) continue;
    const std::int32_t c = cluster_[j];
    if (c != running) *list++ = running = c;
  }
}

/// Where links stand, and which clusters know each other; whatever is free.
void CoarseCorrection::findPattern(const BlockSystem& a, const SweptSystem& swept) {
  const std::size_t n = a.size();
  start_.resize(n + 1);
  forEachIndex(n, [&](std::size_t k) { start_[k] = countLinks(a, swept.source[k]); });
  std::int32_t links = 0;
  start_[n] = 0;
  for (std::int32_t& start : start_) links += std::exchange(start, links);
  link_.resize(links + kPadding), block_.resize(links + kPadding), mirror_.resize(links);
  rowOf_.resize(links), blockByCluster_.resize(links);
  std::fill(link_.end() - kPadding, link_.end(), 0);
  forEachIndex(n, [&](std::size_t k) { listLinks(a, swept.source[k], &link_[start_[k]]); });
  listByCluster(swept);
  factor_.order(matrix_);
}

/// Of each cluster the rows that know it, cluster after cluster of theirs.
void CoarseCorrection::listByCluster(const SweptSystem& swept) {
  std::vector<std::vector<std::int32_t>> known(clusters_), place(clusters_);  // and how often, then where
  tbb::parallel_for(std::size_t{0}, clusters_, [&](std::size_t g) {
    std::vector<std::int32_t> slot(clusters_, -1);
    forEachLinkOf(swept, g, [&](std::int32_t, std::int32_t e) {
      std::int32_t& at = slot[link_[e]];
      if (at < 0) {
        at = static_cast<std::int32_t>(known[g].size());
        known[g].push_back(link_[e]), place[g].push_back(0);
      }
      ++place[g][at];
    });
  });
  matrix_.start.assign(1, 0), matrix_.other.clear(), startOf_.assign(clusters_ + 1, 0);
  for (std::size_t g = 0; g < clusters_; ++g) {
    matrix_.other.insert(matrix_.other.end(), known[g].begin(), known[g].end());
    matrix_.start.push_back(static_cast<std::int32_t>(matrix_.other.size()));
    for (std::size_t s = 0; s < known[g].size(); ++s) startOf_[known[g][s] + 1] += place[g][s];
  }
  matrix_.block.resize(matrix_.other.size());
  std::partial_sum(startOf_.begin(), startOf_.end(), startOf_.begin());
  std::vector<std::int32_t> next(startOf_.begin(), startOf_.end() - 1);
  for (std::size_t g = 0; g < clusters_; ++g)
    for (std::size_t s = 0; s < known[g].size(); ++s) {
      std::int32_t& begin = next[known[g][s]];
      begin += std::exchange(place[g][s], begin);
    }
  tbb::parallel_for(std::size_t{0}, clusters_, [&](std::size_t g) {
    std::vector<std::int32_t> at(clusters_);
    for (std::size_t s = 0; s < known[g].size(); ++s) at[known[g][s]] = place[g][s];
    forEachLinkOf(swept, g, [&](std::int32_t k, std::int32_t e) {
      mirror_[e] = at[link_[e]]++;
      rowOf_[mirror_[e]] = k;
    });
  });
}

/// Calls use(row as swept, link) for the links of the rows of cluster g.
template <typename Use>
void CoarseCorrection::forEachLinkOf(const SweptSystem& swept, std::size_t g, const Use& use) const {
  for (std::int32_t i = firstRow_[g]; i < firstRow_[g + 1]; ++i) {
    const std::int32_t k = swept.placeOf(i);
    for (std::int32_t e = start_[k]; e < start_[k + 1]; ++e) use(k, e);
  }
}

void CoarseCorrection::fillRow(const BlockSystem& a, const SweptSystem& swept, std::size_t i) {
  const std::int32_t first = start_[swept.placeOf(i)];
  forEachLink(a, i, [&](std::int32_t number, const SymmetricSum& block) {
    block_[first + number] = SymmetricBlock(block);
    blockByCluster_[mirror_[first + number]] = block_[first + number];
  });
}

/// Its row of Z^T A Z.
void CoarseCorrection::sumCluster(const SweptSystem& swept, std::size_t g) {
  const std::int32_t first = matrix_.start[g], last = matrix_.start[g + 1];
  std::vector<SymmetricSum> sums(last - first);
  std::vector<std::int32_t> slot(clusters_);
  for (std::int32_t s = first; s < last; ++s) slot[matrix_.other[s]] = s - first;
  for (std::int32_t i = firstRow_[g]; i < firstRow_[g + 1]; ++i) {
    if (!isFree_[i]) continue;
    const std::int32_t k = swept.placeOf(i);
    for (std::int32_t e = start_[k]; e < start_[k + 1]; ++e) sums[slot[link_[e]]].add(block_[e]);
  }
  for (std::int32_t s = first; s < last; ++s) matrix_.block[s] = sums[s - first].matrix();
}

/// A cluster in which nothing is free counts as held by 1, and is not pulled.
void CoarseCorrection::factor() {
  if (clusters_ == 0) return;
  held_ = matrix_;
  for (std::size_t g = 0; g < clusters_; ++g) {
    const auto first = isFree_.begin() + firstRow_[g], last = isFree_.begin() + firstRow_[g + 1];
    if (std::find(first, last, 1) != last) continue;
    for (std::int32_t e = held_.start[g]; e < held_.start[g + 1]; ++e)
      if (held_.other[e] == static_cast<std::int32_t>(g)) held_.block[e].setIdentity();
  }
  factor_.factor(held_);
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

Eigen::Vector3d CoarseCorrection::pullOf(std::size_t c, const Eigen::Vector4f* v) const {
  DoubleQuad sum = {};
  for (std::int32_t e = startOf_[c]; e < startOf_[c + 1]; ++e)
    addTo(sum, blockByCluster_[e].times(loadQuad(v[rowOf_[e]])));
  return {sum[0], sum[1], sum[2]};
}

}  // namespace spume::foam
