#pragma once

#include <vector>

#include "foam/swept_system.h"

namespace spume::foam {

/// Incomplete Cholesky factor (D + L) D^-1 (D + L)^T of each block of a SweptSystem: L are the couplings with
/// earlier rows as they stand, D_i = A_ii - sum over earlier k of B_ik D_k^-1 B_ik [Meijerink and van der
/// Vorst 1977]. Exact for chains and trees; its set-up costs two products. D stays positive definite:
/// couplings B are positive semidefinite and D_k - B_ik too (by induction D_k >= own_k + sum of B_kj over
/// later j), so B D_k^-1 B <= B. With no couplings inside blocks D is the diagonal: block Jacobi.
struct IncompleteCholesky {
  std::vector<SymmetricBlock> pivot;    ///< D [kg]
  std::vector<SymmetricBlock> inverse;  ///< D^-1 [1/kg]
  std::vector<SymmetricBlock> excess;   ///< diagonal of A - 2 D [kg]

  void factor(const SweptSystem& a);
  /// Takes on the diagonals that SweptSystem::refresh has changed, each by itself: D grows by what A has
  /// grown. What that does to later rows is left out; D stays positive definite, as above.
  void refresh(const SweptSystem& a);

 private:
  void setPivot(const SweptSystem& a, std::size_t k, const Eigen::Matrix3d& d);
};

}  // namespace spume::foam
