#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "foam/swept_system.h"

namespace spume::foam {

/// What an incomplete factor does not see: clusters of some hundred rows that move as one. With Z the
/// translations of clusters, conjugate gradients take on M^-1 + kShare Z (Z^T A Z)^-1 Z^T [Dryja and Widlund
/// 1990]. Their matrix is small and its inverse dense; what a translation does to A is a few blocks a row.
///
/// Rows that something outside holds more stiffly than their neighbours do (pins, walls) belong to no
/// cluster, which they would hold whole. The inverse is that of the system build() has seen: when own blocks
/// change, it stays what it was, a preconditioner, and A Z follows exactly.
class CoarseCorrection {
 public:
  /// Clusters at most, and rows of one at least: twice the clusters take eight times the time to invert.
  static constexpr std::size_t kMostClusters = 128, kLeastRows = 512;
  /// With fewer clusters than this the factor alone is as quick.
  static constexpr std::size_t kLeastClusters = 16;

  /// Takes on `a`, of which `swept` is a copy. With `wanted` false, or too few rows, there are no clusters,
  /// and a correction costs nothing.
  void build(const BlockSystem& a, const SweptSystem& swept, bool wanted);
  /// Takes on own blocks of `rows` (numbered as in `a`) that have changed.
  void refresh(const BlockSystem& a, const SweptSystem& swept, const std::vector<std::int32_t>& rows);

  std::size_t clusters() const { return clusters_; }
  /// The cluster of row i of the BlockSystem; clusters() where it is in none.
  std::size_t clusterOf(std::size_t i) const { return isFree_[i] ? cluster_[i] : clusters_; }
  /// Z^T b.
  void sumUp(const Vectors3& b, Eigen::VectorXd& sums) const;
  /// How clusters are to move where the rows of each are pulled by `sums`: kShare (Z^T A Z)^-1 sums.
  void solve(const Eigen::VectorXd& sums, Eigen::VectorXd& motion) const;
  /// Row k (as swept) of A Z motion, where `motion` has a list of clusters() + 1 with a 0 at its end. Adds to
  /// the clusters' `sums` what the row brings to Z^T A (v + Z motion); v is what
  /// it moves by beside its cluster.
  Quad exchange(std::size_t k, const Quad& v, const Eigen::Vector4f* motion, Eigen::Vector4f* sums) const {
    const std::int32_t last = start_[k + 1];
    Quad image = {};
    if (start_[k] == last) return image;
    const Quad all = v + loadQuad(motion[home_[k]]);
    for (std::int32_t e = start_[k]; e < last; ++e) {
      const std::int32_t c = link_[e];
      const auto [ofClusters, ofAll] = block_[e].times(loadQuad(motion[c]), all);
      image += ofClusters, sums[c] = toVector(loadQuad(sums[c]) + ofAll);
    }
    return image;
  }

 private:
  template <typename Use>
  void forEachLink(const BlockSystem& a, std::size_t i, const Use& use) const;
  std::int32_t countLinks(const BlockSystem& a, std::size_t i) const;
  template <typename Use>
  void fillRow(const BlockSystem& a, const SweptSystem& swept, std::size_t i, const Use& use);
  void fillCluster(const BlockSystem& a, const SweptSystem& swept, std::size_t g);
  void invert();
  /// The rows of cluster g of the BlockSystem are firstRow(g) .. firstRow(g + 1) - 1.
  std::size_t firstRow(std::size_t g) const { return (g * cluster_.size() + clusters_ - 1) / clusters_; }
  /// Whether row j of the BlockSystem belongs to cluster g.
  bool isIn(std::int32_t g, std::int32_t j) const { return j >= firstRow_[g] && j < firstRow_[g + 1]; }

  std::size_t clusters_ = 0;
  std::vector<std::int32_t> cluster_;   ///< by row of the BlockSystem
  std::vector<std::int32_t> firstRow_;  ///< by cluster, and n
  std::vector<std::uint8_t> isFree_;    ///< whether it moves with its cluster
  /// A Z by rows as swept: of each row first its own cluster, then others, some of them twice.
  std::vector<std::int32_t> start_, link_;
  std::vector<SymmetricBlock> block_;
  std::vector<std::int32_t> home_;    ///< clusterOf() by rows as swept
  Eigen::MatrixXd matrix_, inverse_;  ///< factor of Z^T A Z, kShare of its inverse; lower halves
};

}  // namespace spume::foam
