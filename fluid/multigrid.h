#pragma once

#include <vector>

#include "fluid/dense_field.h"
#include "fluid/pocket_border.h"
#include "fluid/pressure_system.h"

namespace spume::fluid {

/// Preconditioner for the pressure: one symmetric W cycle in float. Levels are made by aggregating 2^3
/// cells, interpolation is piecewise constant, and the coarse matrix is half the Galerkin product, which
/// makes up for the over-stiff coarse space (model of [Braess 1995]): coarse weight = half the sum of its
/// four fine ones, coarse excess = half the sum of its children's. Red-black Gauss-Seidel smooths, red first
/// before the coarse correction and black first after it, pockets last before and first after it, so that
/// x.My = y.Mx and conjugate gradients may use it.
class Multigrid {
 public:
  explicit Multigrid(const Eigen::Vector3i& cells);

  PressureMatrix& finest() { return levels_.front().matrix; }
  const PressureMatrix& finest() const { return levels_.front().matrix; }

  /// Makes the coarse levels; call after finest() has been assembled and finished.
  void coarsen();
  /// Borders the matrix with the unknowns of pockets, on all levels; until then it has none.
  void border(const PocketUnknowns& pockets);

  DenseField<float>& rightHandSide() { return levels_.front().rhs; }  ///< 0 where there is no unknown
  const DenseField<float>& solution() const { return levels_.front().x; }
  std::vector<float>& pocketRightHandSide() { return pocketRhs_; }  ///< empty: all 0
  const std::vector<float>& pocketSolution() const { return levels_.front().border.solution(); }
  /// solution() = M rightHandSide(), and so those of the pockets. With pockets it uses rightHandSide() up.
  void cycle();

 private:
  struct Level {
    PressureMatrix matrix;
    DenseField<float> x, rhs;
    PocketBorder border;
    explicit Level(const Eigen::Vector3i& cells) : matrix(cells), x(cells), rhs(cells) {}
  };
  void visit(std::size_t depth);
  /// Half a sweep of Gauss-Seidel. `start` is a red one from x = 0.
  enum class HalfSweep { start, red, black };
  void partCycle(std::size_t depth, HalfSweep first);
  static void aggregate(const PressureMatrix& fine, PressureMatrix& coarse);
  static void smoothDown(Level& level, HalfSweep first, int sweeps);
  static void smoothUp(Level& level, int sweeps);
  static void sweep(Level& level, int halves, HalfSweep first, HalfSweep second);
  static void relax(Level& level, HalfSweep half, const ActiveRow& row);
  static void restrictResidual(const Level& fine, Level& coarse);
  static void restrictPiece(const Level& fine, Level& coarse, const ActiveRow& piece);
  static void addCorrection(const Level& coarse, Level& fine);

  std::vector<Level> levels_;
  std::vector<float> pocketRhs_;
};

}  // namespace spume::fluid
