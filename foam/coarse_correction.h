#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "foam/envelope_cholesky.h"
#include "foam/swept_system.h"

namespace spume::foam {

/// What an incomplete factor does not see: clusters of some hundred rows that move as one. With Z the
/// translations of clusters, conjugate gradients add to what the factor answers the motions Z m that take
/// from the residual what clusters still feel of it, Z^T A Z m = Z^T (r - A y): the factor then has to find
/// only what happens within clusters [Nicolaides 1987; Tang, Nabben, Vuik and Erlangga 2009, A-DEF2]. What a
/// translation does to A is a few blocks a row.
///
/// Rows that something outside holds more stiffly than their neighbours do (pins, walls) belong to no
/// cluster, which they would hold whole.
class CoarseCorrection {
 public:
  /// Rows of a cluster at least, and clusters at most: the time to factor their matrix grows with the cube of
  /// their number at first.
  static constexpr std::size_t kLeastRows = 384, kMostClusters = 256;
  /// With fewer clusters than this the factor alone is as quick.
  static constexpr std::size_t kLeastClusters = 16;

  /// Takes on `a`, of which `swept` is a copy; factor() comes next. With `wanted` false, or too few rows,
  /// there are no clusters, and a correction costs nothing.
  void build(const BlockSystem& a, const SweptSystem& swept, bool wanted);
  /// Factors the clusters' matrix, on this thread.
  void factor();
  /// Takes on own blocks of `rows` (numbered as in `a`) that have changed. Where they are few the factor of
  /// the clusters' matrix stays what it was.
  void refresh(const BlockSystem& a, const SweptSystem& swept, const std::vector<std::int32_t>& rows);

  std::size_t clusters() const { return clusters_; }
  /// The cluster of row i of the BlockSystem; clusters() where it is in none.
  std::size_t clusterOf(std::size_t i) const { return isFree_[i] ? cluster_[i] : clusters_; }
  /// Z^T b.
  void sumUp(const Vectors3& b, Eigen::VectorXd& sums) const;
  /// Z^T A Z motion.
  void stiffen(const Eigen::VectorXd& motion, Eigen::VectorXd& pull) const { matrix_.times(motion, pull); }
  /// How clusters move where the rows of each are pulled by `pull`: (Z^T A Z)^-1 pull.
  void solve(const Eigen::VectorXd& pull, Eigen::VectorXd& motion) const { factor_.solve(pull, motion); }
  /// Row k (as swept) of A Z motion, where `motion` has a list of clusters() + 1 with a 0 at its end.
  Quad image(std::size_t k, const Eigen::Vector4f* motion) const {
    constexpr auto kStep = static_cast<std::int32_t>(kQuads);
    const std::int32_t last = start_[k + 1];
    QuadLanes sum = {};
    for (std::int32_t e = start_[k]; e < last; e += kStep)
      sum += timesQuads(&block_[e], last - e, gatherQuads(motion, &link_[e]));
    return joinQuads(sum);
  }
  /// Cluster c of Z^T A v, where `v` has a vector for each row as swept.
  Eigen::Vector3d pullOf(std::size_t c, const Eigen::Vector4f* v) const;

 private:
  void forgetMatrix();
  template <typename Use>
  void forEachLink(const BlockSystem& a, std::size_t i, const Use& use) const;
  std::int32_t countLinks(const BlockSystem& a, std::size_t i) const;
  void listLinks(const BlockSystem& a, std::size_t i, std::int32_t* list) const;
  void findPattern(const BlockSystem& a, const SweptSystem& swept);
  void listByCluster(const SweptSystem& swept);
  template <typename Use>
  void forEachLinkOf(const SweptSystem& swept, std::size_t g, const Use& use) const;
  void fillRow(const BlockSystem& a, const SweptSystem& swept, std::size_t i);
  void sumCluster(const SweptSystem& swept, std::size_t g);
  /// The rows of cluster g of the BlockSystem are firstRow(g) .. firstRow(g + 1) - 1.
  std::size_t firstRow(std::size_t g) const { return (g * cluster_.size() + clusters_ - 1) / clusters_; }

  std::size_t clusters_ = 0;
  std::vector<std::int32_t> cluster_;   ///< by row of the BlockSystem
  std::vector<std::int32_t> firstRow_;  ///< by cluster, and n
  std::vector<std::uint8_t> isFree_;    ///< whether it moves with its cluster
  /// A Z by rows as swept: of each row first its own cluster, then others.
  std::vector<std::int32_t> start_, link_;
  std::vector<SymmetricBlock> block_;
  /// The same by clusters, and where each link of a row stands there.
  std::vector<std::int32_t> startOf_, rowOf_, mirror_;
  std::vector<SymmetricBlock> blockByCluster_;
  SparseBlocks matrix_, held_;  ///< Z^T A Z, and what of it is factored
  EnvelopeCholesky factor_;
  std::vector<std::int32_t> stale_;  ///< rows whose links refresh() has to find again
  std::vector<std::uint8_t> isStale_, staleCluster_;
};

}  // namespace spume::foam
