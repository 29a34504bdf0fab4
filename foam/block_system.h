#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace spume::foam {

using Vectors3 = std::vector<Eigen::Vector3d>;

/// Coupling of two bubbles: the symmetric positive semidefinite block along along^T + across I [kg].
struct CouplingBlock {
  Eigen::Vector3d along;  ///< [kg^1/2]
  double across;          ///< [kg]

  Eigen::Vector3d times(const Eigen::Vector3d& v) const { return along.dot(v) * along + across * v; }
};

/// Symmetric positive definite matrix of the implicit step, 3 x 3 blocks on the graph of pairs:
/// (A v)_i = own_i v_i + sum_j block_ij (v_i - v_j). Written with differences, so a rigid motion costs no
/// cancellation. Solvers work from neighbour to neighbour: rows are best numbered along a curve through
/// space.
struct BlockSystem {
  std::vector<Eigen::Matrix3d> own;  ///< [kg]
  std::vector<std::int32_t> start;   ///< n + 1; couplings of bubble i
  std::vector<std::int32_t> other;
  std::vector<CouplingBlock> block;

  std::size_t size() const { return own.size(); }
  Eigen::Vector3d row(std::size_t i, const Vectors3& v) const {
    Eigen::Vector3d sum = own[i] * v[i];
    for (std::int32_t e = start[i]; e < start[i + 1]; ++e) sum += block[e].times(v[i] - v[other[e]]);
    return sum;
  }
  Eigen::Matrix3d diagonal(std::size_t i) const;
};

}  // namespace spume::foam
