#pragma once

#include <array>
#include <cstdint>

#include "fluid/dense_field.h"
#include "fluid/fluid_params.h"
#include "fluid/grid_spec.h"
#include "fluid/solid_boundary.h"

namespace spume::fluid {

/// Implicit viscosity in variational form [Batty, Bridson 2008]: the new velocity minimises
///   sum over faces of m (u - u*)^2 / 2 + dt nu sum over stress samples of W (e_aa^2 + 2 e_ab^2),
/// e the rate of strain, m and W the liquid fractions of the control volumes. So the surface is free of
/// traction and rigid motion is free of stress, which a Laplacian of each component is not: it would damp
/// waves at half their rate. Solids and inflows hold their faces; walls of the domain stand between faces.
/// Deviations: fractions come from the liquid fractions of cells instead of super-sampling, and a solid
/// inside the domain stands where its nearest closed face is: first order in dx there. Faces without liquid
/// are not solved for: they would follow so that the shear around them vanishes, so that shear is left out at
/// once. With them a drop of 24 cells across takes 500 iterations instead of a dozen.
class Viscosity {
 public:
  Viscosity(const GridSpec& grid, const FluidParams& params);

  /// Applies the stress of dt [s] to the faces that carry liquid. `velocity`: ghosts need no values. Does
  /// nothing if the params' viscosity is 0. Throws NumericalFailure if the solve does not converge, and then
  /// velocity is as before.
  void apply(const DenseField<float>& phi, const SolidBoundary& boundary, double dt, MacVelocity& velocity);

  int iterations() const { return iterations_; }  ///< of the last solve

 private:
  using Vector = MacField<double>;
  void weigh(const DenseField<float>& phi, const SolidBoundary& boundary);
  float edgeWeight(const SolidBoundary& boundary, int a, int b, const Eigen::Vector3i& c) const;
  bool isDry(int axis, const Eigen::Vector3i& face) const;
  bool isHeld(const SolidBoundary& boundary, int axis, const Eigen::Vector3i& face) const;
  bool solve(double fastest, double k);
  void multiply(const Vector& x, double k, Vector& y) const;
  void multiplyRow(const Vector& x, double k, int axis, int i, int j, double* y) const;
  void invertDiagonal(double k);

  GridSpec grid_;
  double kinematic_;  // nu [m^2/s]
  bool noSlip_;
  int iterations_ = 0;
  double error_ = 0;                        // largest residual over its diagonal [m/s]
  DenseField<float> fraction_;              // liquid fraction of each cell, ghosts as their nearest cell
  MacField<float> mass_;                    // m of each face
  std::array<DenseField<float>, 3> shear_;  // W of the edges; [a] has those across the other two axes
  MacField<float> inverse_;                 // 1/diagonal, 0 on faces that are not solved for
  Vector start_, change_, residual_, direction_, image_;
};

}  // namespace spume::fluid
