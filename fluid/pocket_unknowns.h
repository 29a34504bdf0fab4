#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fluid/dense_field.h"

namespace spume::fluid {

/// A face between a liquid cell and a closed air pocket.
struct PocketSurface {
  Eigen::Vector3i cell;  ///< the liquid one
  int axis, side;        ///< towards the pocket
  std::int32_t pocket;
  float coefficient;  ///< open/theta, as in the matrix
  double known;       ///< pressure at the surface less the pocket's unknown, in the unit of the unknowns
};

/// One pressure unknown per closed pocket of air, beside those of the liquid's cells [Goldade et al. 2020]:
/// the border of the pressure matrix. With A that of the cells, whose excess holds the coefficients towards
/// pockets, the system is
///   A x - B r = b,   D r - B^T x = c,   B = coefficients, D = their sum per pocket,
/// symmetric and positive definite as long as some surface is open air.
class PocketUnknowns {
 public:
  std::vector<PocketSurface> surfaces;  ///< in the order of their cells
  std::vector<double> diagonal;         ///< D
  std::vector<double> residual;         ///< c; the solver leaves c - D r + B^T x here
  std::vector<double> solution;         ///< r

  /// Forgets all surfaces; `pockets` unknowns.
  void clear(std::size_t pockets);
  bool empty() const { return surfaces.empty(); }
  /// Sums the diagonal; call when the surfaces stand.
  void finish();

  // The parts of a conjugate-gradient iteration that concern the border; vectors as in ConjugateGradient.
  double largestResidual() const;
  /// The same, each scaled down to a diagonal of at most `diagonalLimit`.
  double largestResidual(double diagonalLimit) const;
  /// Residual . `preconditioned` residual.
  double dot(const std::vector<float>& preconditioned) const;
  /// direction = scale preconditioned + factor direction.
  void turn(double scale, const std::vector<float>& preconditioned, double factor);
  /// Completes image = matrix times direction: adds -B d to that of the cells; returns what the border adds
  /// to direction . image.
  double multiply(const DenseField<double>& direction, DenseField<double>& image);
  void advance(double step);

 private:
  std::vector<double> direction_, image_;
};

}  // namespace spume::fluid
