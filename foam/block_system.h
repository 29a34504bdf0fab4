#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace spume::foam {

using Vectors3 = std::vector<Eigen::Vector3d>;

/// Coupling of two bubbles: the symmetric positive semidefinite block along along^T + across I [kg].
/// Numbers in single precision: springs are exact to 1e-7 of their stiffness, the same from both sides, and a
/// system moves half the memory.
struct CouplingBlock {
  Eigen::Vector4f number;  ///< along [kg^1/2] and, last, across [kg]

  CouplingBlock() = default;
  CouplingBlock(const Eigen::Vector3d& along, double across) {
    number << along.cast<float>(), static_cast<float>(across);
  }
  Eigen::Vector3d along() const { return number.head<3>().cast<double>(); }
  double across() const { return number[3]; }
  Eigen::Vector3d times(const Eigen::Vector3d& v) const {
    const Eigen::Vector3d n = along();
    return n.dot(v) * n + across() * v;
  }
};

/// Symmetric positive definite matrix of the implicit step, 3 x 3 blocks on the graph of pairs:
/// (A v)_i = own_i v_i + sum_j block_ij (v_i - v_j). Written with differences, so a rigid motion costs no
/// cancellation. Solvers work from neighbour to neighbour: rows are best numbered along a curve through
/// space.
struct BlockSystem {
  std::vector<Eigen::Matrix3d> own;  ///< [kg]
  std::vector<std::int32_t> start;   ///< n + 1; couplings of bubble i
  std::vector<std::int32_t> other;   ///< by coupling
  std::vector<CouplingBlock> block;  ///< by coupling, the same from both sides

  std::size_t size() const { return own.size(); }
  Eigen::Vector3d row(std::size_t i, const Vectors3& v) const {
    Eigen::Vector3d sum = own[i] * v[i];
    for (std::int32_t e = start[i]; e < start[i + 1]; ++e) sum += block[e].times(v[i] - v[other[e]]);
    return sum;
  }
  Eigen::Matrix3d diagonal(std::size_t i) const;
};

}  // namespace spume::foam
