#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "fluid/dense_field.h"

namespace spume::fluid {

class PocketUnknowns;

/// The unknowns of closed pockets of air on one level of the multigrid. What a pocket is coupled to becomes
/// coarser from level to level, the pocket itself stays one unknown: the pressure it shares with all the
/// liquid round it is smooth, and only coarse levels can move the two together. Without that, each pocket
/// costs conjugate gradients as many iterations as an outlying eigenvalue does.
class PocketBorder {
 public:
  /// Takes the couplings of the finest level.
  void assemble(const PocketUnknowns& pockets);
  /// Half the sum of the finer couplings, as for the cells.
  void coarsen(const PocketBorder& fine);

  bool empty() const { return diagonal_.empty(); }
  /// All pockets at 0, with these right-hand sides, or 0 if there are none.
  void start(const std::vector<float>& rhs);
  /// Gauss-Seidel step of the pockets: each takes the value that its residual vanishes with, and `rhs` of the
  /// cells beside what follows from that, so that relaxing them needs to know nothing of pockets.
  void relax(const DenseField<float>& x, DenseField<float>& rhs);

  /// Where the last `relax` left the pockets.
  const std::vector<float>& solution() const { return value_; }

 private:
  struct Coupling {
    std::size_t pocket;
    Eigen::Vector3i cell;
    float coefficient;
  };
  void merge();

  std::vector<Coupling> couplings_;  // in order of pockets, then cells; one for each pair
  std::vector<float> diagonal_, value_, rhs_;
};

}  // namespace spume::fluid
