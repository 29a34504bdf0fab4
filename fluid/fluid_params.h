#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace spume::fluid {

enum class LevelSetTransport { semiLagrangian, weno5 };
enum class VelocityAdvection { semiLagrangian, macCormack, trapezoidal };

/// Every number that tunes the liquid. `validate()` is called once, by LiquidSolver's constructor.
struct FluidParams {
  Eigen::Vector3d gravity{0, -9.8, 0};  ///< [m/s^2], each component within +-1000
  double density = 1000;                ///< rho [kg/m^3], 1 to 20000; water

  LevelSetTransport levelSetTransport = LevelSetTransport::semiLagrangian;  ///< markers carry the accuracy
  VelocityAdvection velocityAdvection = VelocityAdvection::macCormack;      ///< second order, clamped
  double cfl = 4;  ///< largest max|u| dt/dx of one sub-step, 0.2 to 10

  int markersPerCell = 16;       ///< per sign, 8 to 64; 16 gives the same births as 64 at a third of the time
  double markerBand = 3;         ///< half-width of the seeded band [cells], 2 to 5 (Enright 2002)
  double markerRadiusMin = 0.1;  ///< [dx] (Enright 2002)
  double markerRadiusMax = 0.5;  ///< [dx] (Enright 2002)
  int reseedInterval = 10;       ///< sub-steps between reseedings, 1 to 1000
  double escapeDepth = 1;        ///< depth at which a positive marker leaves the set [dx], 0.5 to 3
  double impactReach = 0.01;     ///< how far around lost air streams that meet are looked for [m], 1e-4 to 1

  double pressureTolerance = 1e-6;  ///< relative residual of the pressure solve, 1e-12 to 1e-2
  int pressureIterations = 200;     ///< limit of the pressure solve, 1 to 10000
  bool volumeControl = true;        ///< hold every connected body at its booked volume (Kim et al. 2007)
  /// Relaxation time of the volume error [s], 0.001 to 10. What the level set loses steadily is made up for
  /// besides; a sudden loss stands for about this long: in a violent dam break of 64^3 0.2 to 0.4 % of
  /// the liquid, with twice this time 0.41 to 0.56 %.
  double volumeControlTime = 0.0025;

  double viscosity = 0;       ///< mu [Pa s], 0 to 1e4; 0: none. Water 1e-3, honey 10
  bool noSlip = true;         ///< viscous liquid sticks to solids; false: it slides along them freely
  double surfaceTension = 0;  ///< sigma [N/m], 0 to 10; 0: none. Water 0.0728; shortens the sub-steps

  std::uint64_t seed = 1;  ///< of every random number the liquid draws

  /// Throws InvalidParameter naming the first field out of range.
  void validate() const;
};

}  // namespace spume::fluid
