#pragma once

#include "fluid/dense_field.h"
#include "fluid/fluid_params.h"
#include "fluid/grid_spec.h"
#include "fluid/row_spans.h"
#include "fluid/solid_boundary.h"

namespace spume::fluid {

/// Moves phi with the liquid: phi_t + u . grad phi = 0. Holds scratch fields, so a step allocates nothing.
class LevelSetAdvection {
 public:
  explicit LevelSetAdvection(const GridSpec& grid);

  /// Advances phi by dt [s] with the velocity frozen. Reads and refills the ghosts of phi; those of
  /// `velocity` must be filled. Cells that the band cannot reach are left as they are. The level set inside
  /// solids is not moved: follow with SolidExtension::apply. With `solids` nothing passes thin walls.
  void advance(LevelSetTransport transport, const MacVelocity& velocity, double dt, DenseField<float>& phi,
               const SolidBoundary* solids = nullptr);

  /// Backtrace by the midpoint rule, limited cubic interpolation [Enright, Losasso, Fedkiw 2005, linear
  /// there].
  void semiLagrangian(const MacVelocity& velocity, double dt, DenseField<float>& phi);
  /// Fifth-order WENO in space [Jiang, Peng 2000], third-order TVD Runge-Kutta in time [Shu, Osher 1988], in
  /// as many equal stages of CFL <= kWenoCfl as dt needs.
  void weno5(const MacVelocity& velocity, double dt, DenseField<float>& phi);

 private:
  void centreVelocity(const MacVelocity& velocity);
  void wenoRate(const DenseField<float>& phi);
  void combine(DenseField<float>& phi, float ofStart, float dt) const;
  void findMoving(const DenseField<float>& phi, const MacVelocity& velocity, double dt);
  float valueBesideWall(const DenseField<float>& phi, const MacVelocity& velocity, float cellsPerSpeed,
                        const Eigen::Vector3i& c) const;
  void keepSides(const DenseField<float>& phi, const MacVelocity& velocity, double dt,
                 DenseField<float>& moved) const;

  GridSpec grid_;
  RowSpans moving_;  ///< cells the band may reach in this step
  DenseField<float> start_, next_, rate_, centreU_, centreV_, centreW_;
  DenseField<std::uint8_t> kinks_;
  const SolidBoundary* solids_ = nullptr;  ///< of the call under way, if it has a thin wall
};

}  // namespace spume::fluid
