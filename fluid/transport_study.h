#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>

#include "fluid/fluid_params.h"
#include "fluid/grid_spec.h"
#include "fluid/liquid_state.h"

namespace spume::fluid {

/// A surface carried by a given velocity that brings it back to where it started: the standard tests of
/// surface tracking. Positions in the case's own unit of length, velocities per unit of time.
struct TransportCase {
  std::string name;
  Eigen::Vector3d size;                                  ///< of the domain, from the origin
  bool planar = false;                                   ///< 2D: a slab kSlabCells cells thick
  double duration = 1;                                   ///< of one round trip
  std::function<double(const Eigen::Vector3d& x)> phi0;  ///< signed distance, < 0 inside
  std::function<Eigen::Vector3d(const Eigen::Vector3d& x)> velocity;
  std::function<double(double t)> timeFactor;  ///< multiplies the velocity; empty: 1
};

/// Slotted disk of Zalesak (1979) in a 100 x 100 domain, radius 15, slot 5 wide, one turn in 628.
TransportCase zalesakDisk();
/// Slotted sphere in the unit cube, radius 0.15, slot 0.05 wide and 0.125 deep, one turn in 1.
TransportCase zalesakSphere();
/// Disk in the reversed single vortex, T = 8 [Rider, Kothe 1998].
TransportCase singleVortex();
/// Slotted disk of Rudman (1998): radius 0.5 in a box of 4, slot 0.12 wide and 0.6 deep, one turn in 2 pi.
TransportCase rudmanDisk();
/// Sphere in the reversed deformation field, T = 3 [LeVeque 1996; Enright 2002].
TransportCase enrightDeformation();

struct TransportOptions {
  int cells = 64;    ///< along the longest edge of the domain
  double cfl = 0.5;  ///< max|u| dt/dx
  bool markers = true;
  bool reinitialise = true;
  bool budget = false;  ///< follow the volume that escaped negative markers stand for
  FluidParams params;   ///< transport scheme, markersPerCell and so on
};

struct TransportResult {
  double volumeChange =
      0;                  ///< (end - start)/start; start is the exact volume of phi0 from 8^3 samples a cell
  double shapeError = 0;  ///< E1 = sum |f_end - f_exact| dV, per depth of the slab when planar
  double lostThickness = 0;   ///< of the thickest part that is air at the end: twice its depth
  double interfaceError = 0;  ///< E1 over the exact area (length) of the surface
  double escaped = 0;         ///< what markers hold beside the grid where phi is in doubt, of the start
  double leastShown = 1;      ///< smallest volume of the grid on the way, of the start, with `budget`
  double worstBudget = 0;     ///< largest |grid + escaped - start|/start on the way, with `budget`
  double seconds = 0;
  int steps = 0;
  LiquidState state;  ///< at the end
};

/// Called after every step with the time reached.
using TransportWatch = std::function<void(const LiquidState& state, double t)>;

/// Runs the case in the order of LiquidSolver's sub-step: transport, correction, reinitialisation,
/// correction, radius adjustment, reseeding.
TransportResult runTransport(const TransportCase& scene, const TransportOptions& options,
                             const TransportWatch& watch = {});

/// Fraction of every cell where phi0 < 0, from 8^3 samples.
DenseField<float> sampledFraction(const GridSpec& grid,
                                  const std::function<double(const Eigen::Vector3d&)>& phi0);

}  // namespace spume::fluid
