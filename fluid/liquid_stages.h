#pragma once

#include <cstdint>
#include <vector>

#include "fluid/air_pockets.h"
#include "fluid/crowding.h"
#include "fluid/drops.h"
#include "fluid/extrapolation.h"
#include "fluid/level_set.h"
#include "fluid/level_set_advection.h"
#include "fluid/liquid_bodies.h"
#include "fluid/liquid_solver.h"
#include "fluid/marker_correction.h"
#include "fluid/marker_escape.h"
#include "fluid/marker_particles.h"
#include "fluid/path_acceleration.h"
#include "fluid/pocket_books.h"
#include "fluid/projection.h"
#include "fluid/pushes.h"
#include "fluid/reinitialize.h"
#include "fluid/solid_extension.h"
#include "fluid/surface_lift.h"
#include "fluid/velocity_advection.h"
#include "fluid/viscosity.h"
#include "fluid/volume_control.h"
#include "fluid/wall_slip.h"

namespace spume::fluid {

/// The velocity must reach beyond the fastest sub-step and the stencil of its interpolation [cells].
inline constexpr int kStencilReach = 3;

/// Steps that fill an interval up to round-off must not be given one more.
inline constexpr double kRoundOff = 1e-9;

/// Everything a solver holds, and the stages of its sub-step in the order subStep() calls them.
struct LiquidStages {
  LiquidStages(FluidParams p, LiquidSetup s);
  /// Brings everything derived from the state up to date with it.
  void start();
  /// Starts the books of the closed pockets, and completes the ledger of the state.
  void startPockets();
  /// Hands the ledger of the state back to volume control, with bodies as the last sub-step saw them.
  void resumeControl();

  FluidParams params;
  LiquidSetup setup;
  LiquidState state, before;
  SolidBoundary solids;
  InflowSet inflows;
  OutflowSet outflows;

  SolidExtension extension;
  LevelSetAdvection levelSetAdvection;
  Crowding crowding;
  SurfaceLift surfaceLift;
  Reinitializer reinitializer;
  VelocityAdvector velocityAdvector;
  PathAcceleration acceleration;
  VelocityExtrapolator extrapolator;
  MarkerSorter sorter;
  MarkerSeeder seeder;
  MarkerCorrection correction;
  MarkerEscape escape;
  Drops drops;
  AirPockets pockets;
  PocketBooks pocketBooks;
  LiquidBodies bodies;
  VolumeControl volumeControl;
  WallSlip wallSlip;
  Viscosity viscosity;
  Pushes pushes;
  Projection projection;
  MacVelocity surfaceVelocity;  // carries the surface and its markers
  MacVelocity velocityNow;      // without the state's lead; for measures
  DenseField<float> source, psiBefore, phiBefore;
  DenseField<std::int32_t> cellMark;

  std::vector<Drop> landed;  // in this sub-step
  std::vector<Push> pushed;  // not yet given to the liquid
  std::vector<EscapedMarker> escaped;
  std::vector<CollapsedPocket> collapsed;
  std::size_t escapedBefore = 0, collapsedBefore = 0;
  double stepEnd = 0;          ///< of the step whose sub-steps these are [s]
  double maxSpeed = 0;         ///< that is held to `cfl`, see carryingSpeed [m/s]
  double lastAdvance = 0;      ///< time that the velocity advanced in the last sub-step [s]
  bool pocketsFilled = false;  // after they were found in this sub-step
  bool surfaceStands = false;  ///< phi and solids are as in the last extrapolation

  MarkerScene markerScene() const { return {state.grid, params, setup.walls, solids}; }
  double carryingSpeed() const;
  double longestStep() const;
  int subStepsFor(double dt) const;

  double endOf(double dt) const;  ///< where a sub-step of dt from now ends [s]
  double subStep(double dt, const ImmersedGas& gas, LiquidStepReport& report, StageClock& clock);
  bool solidsMove() const;
  void moveSolids(double dt);
  bool crowdsTooMuch(double dt);
  double carrySurface(double dt);
  double transport(double dt, LiquidStepReport& report);
  void restoreDistance();
  void correctSurface(bool flagsStand);
  void loseMarkers();
  void moveDrops(double dt, LiquidStepReport& report);
  void launch(std::vector<Drop> launched, LiquidStepReport& report);
  void findBodies(LiquidStepReport& report);
  void reseed();
  void findPockets(double t);
  void fillPockets(double dt);
  void pour(double dt, const ImmersedGas& gas, LiquidStepReport& report);
  void moveVelocity(double dt, LiquidStepReport& report);
  void slipAlongWalls();
  void applyViscosity(double dt);
  void leapAhead(double dt);
  double velocityAdvance(double dt) const;
  void project(double dt, double advance, LiquidStepReport& report);
  void extrapolate();
  void checkFinite(double dt) const;
  void measure(LiquidStepReport& report);
};

}  // namespace spume::fluid
