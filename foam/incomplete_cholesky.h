#pragma once

#include <vector>

#include "foam/swept_system.h"

namespace spume::foam {

/// Incomplete Cholesky factor (D + L) D^-1 (D + L)^T of a SweptSystem but for couplings of rows swept at the
/// same time: L are the couplings with earlier rows as they stand, D_i = A_ii - sum over earlier k of B_ik
/// D_k^-1 B_ik [Meijerink and van der Vorst 1977]. Exact for chains and trees of one block; its set-up costs
/// two products. D stays positive definite: couplings B are positive semidefinite and D_k - B_ik too (by
/// induction D_k >= own_k + sum of B_kj over later j), so B D_k^-1 B <= B. With no sweeps D is the diagonal:
/// block Jacobi.
///
/// D^-1 is kept as G^T G with G triangular, and what else concerns a row in the coordinates in which D is the
/// unit matrix. A small bubble is up to 1e7 times stiffer along a contact than its inertia across it; numbers
/// in single precision carry both in these coordinates, and in no others.
struct IncompleteCholesky {
  std::vector<TriangularBlock> scale;  ///< G [kg^-1/2]
  std::vector<SymmetricBlock> excess;  ///< G (A_ii - 2 D) G^T [-]

  /// The crew has a.tasks() tasks.
  void factor(Crew& crew, const SweptSystem& a);
  /// Takes on the diagonals that SweptSystem::refresh has changed, each by itself: D grows by what A has
  /// grown. What that does to later rows is left out; D stays positive definite, as above.
  void refresh(const SweptSystem& a, const std::vector<SweptSystem::Growth>& rows);

 private:
  void setPivot(const SweptSystem& a, std::size_t k, const Eigen::Matrix3d& d);

  std::vector<SymmetricSum> inverse_;  ///< D^-1 as sweeps apply it, G^T G [1/kg]
};

}  // namespace spume::foam
