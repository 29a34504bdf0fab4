#pragma once

#include <cstdint>
#include <memory>

#include "fluid/air_pockets.h"
#include "fluid/dense_field.h"
#include "fluid/fluid_params.h"
#include "fluid/grid_spec.h"
#include "fluid/solid_boundary.h"

namespace spume::fluid {

struct ProjectionReport {
  int iterations = 0;
  double residual = 0;      ///< of the solve, relative to the right-hand side without hydrostatic part [-]
  double divergence = 0;    ///< largest |div u - source| dx in liquid cells after rounding to float [m/s]
  double incompatible = 0;  ///< largest mean |div u - source| dx an airless body had to be given up [m/s]
};

struct ProjectionSystem;

/// Closed pockets of air as the projection sees them.
struct HeldPockets {
  const DenseField<std::int32_t>& label;  ///< pocket of each cell, -1 elsewhere
  const std::vector<AirPocket>& pockets;
  std::vector<double> growth;  ///< rate at which the volume of each is to change [m^3/s]
};

/// Makes the velocity of the liquid divergence-free, or of the given divergence, and adds gravity:
/// u = u* + dt g - (dt/rho) grad p on every face that borders a liquid cell, summed in double and rounded
/// once. Free surface at p = 0, or sigma kappa with surface tension, by the ghost-fluid method, second order
/// [Enright et al. 2003]; solids by face fractions [Batty et al. 2007]; the pressure of a closed pocket is
/// one unknown [Goldade et al. 2020]; airless bodies have p of mean 0 and their right-hand side made
/// compatible.
class Projection {
 public:
  Projection(const GridSpec& grid, const FluidParams& params);
  ~Projection();
  Projection(Projection&&) noexcept;

  /// `velocity` in: advected, without gravity; out: projected on valid() faces, the others untouched.
  /// `divergenceSource`: volume created per cell volume and time [1/s]. `pressureGradient` out: on valid
  /// faces [Pa/m], 0 elsewhere. Throws NumericalFailure if the
  /// solve does not reach the tolerance, and then velocity and pressureGradient are as before. `pockets`: the
  /// closed ones that keep their gas; without them all air has p = 0.
  ProjectionReport project(const DenseField<float>& phi, const SolidBoundary& boundary, double dt,
                           const DenseField<float>& divergenceSource, MacVelocity& velocity,
                           MacField<float>& pressureGradient, const HeldPockets* pockets = nullptr);

  /// 1 on faces whose velocity the last project() set or that an inflow or a closed domain wall prescribes
  /// beside liquid: where extrapolation starts from.
  const MacField<std::uint8_t>& valid() const;

  /// Pressure of the last project() in liquid cells and closed pockets, 0 elsewhere [Pa].
  const DenseField<float>& pressure() const;

 private:
  std::unique_ptr<ProjectionSystem> internals_;
};

}  // namespace spume::fluid
