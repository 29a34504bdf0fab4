#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "fluid/fluid_params.h"
#include "fluid/inflow.h"
#include "fluid/liquid_state.h"
#include "fluid/outflow.h"
#include "fluid/pushes.h"
#include "fluid/solid_boundary.h"
#include "fluid/stage_clock.h"

namespace spume::fluid {

/// A positive marker that left the liquid's marker set: air caught under the surface.
struct EscapedMarker {
  Eigen::Vector3d position;  ///< [m]
  Eigen::Vector3d velocity;  ///< of the liquid there [m/s]
  double gas;                ///< air it carries, raw share [m^3]
  double speed;              ///< of the streams that meet there, see impact_speed.h [m/s]
};

/// A closed pocket of air too small for the grid to keep (2 to 4 cells), filled with liquid by this step.
struct CollapsedPocket {
  Eigen::Vector3d position;  ///< centroid [m]
  Eigen::Vector3d velocity;  ///< of the liquid around it [m/s]
  double gas;                ///< [m^3]
  int cells;
  double speed;  ///< of the streams that meet there, see impact_speed.h [m/s]
};

/// Gas of bubbles under the surface, which the grid liquid must make room for.
struct ImmersedGas {
  std::vector<Eigen::Vector3d> position;  ///< [m]
  std::vector<double> volume;             ///< immersed part of each bubble [m^3]
};

/// What a step did. Volumes in m^3.
struct LiquidStepReport {
  int subSteps = 0;
  double cfl = 0;               ///< largest of the sub-steps, by maxSpeed
  double maxSpeed = 0;          ///< [m/s], in the liquid; of faces beyond its surface cfl/(cfl + 1)
  int pressureIterations = 0;   ///< summed over the sub-steps
  double pressureResidual = 0;  ///< worst relative residual
  double divergence = 0;        ///< largest |div u - source| dx in wet cells after projection [m/s]
  double liquidVolume = 0;      ///< of the grid liquid, at the end
  double targetVolume = 0;  ///< what volume control holds: initial + poured - drained - drops + immersed gas
  double poured = 0;        ///< through inflows in this step
  double drained = 0;       ///< out of the domain and through outflows in this step, drops included
  std::size_t drops = 0;    ///< in flight at the end
  double dropVolume = 0;    ///< in them
  double launched = 0;      ///< became drops in this step
  double landed = 0;        ///< came back from drops in this step
  PushReport pushes;        ///< what became of the step's
  double kineticEnergy = 0, potentialEnergy = 0;  ///< of grid liquid and drops [J]
  std::size_t positiveMarkers = 0, negativeMarkers = 0;
  std::vector<StageTime> stages;
};

/// What LiquidSolver is built from.
struct LiquidSetup {
  GridSpec grid;
  DomainWalls walls;
  std::vector<SolidObject> solids;
  std::vector<Inflow> inflows;
  std::vector<Outflow> outflows = {};
};

struct LiquidStages;

/// Particle-level-set Navier-Stokes liquid with a free surface [Enright et al. 2002; Batty et al. 2007].
class LiquidSolver {
 public:
  /// `phi0` is the signed distance to the initial liquid at a world point [m], < 0 inside.
  /// Throws InvalidParameter.
  LiquidSolver(FluidParams params, LiquidSetup setup,
               const std::function<double(const Eigen::Vector3d&)>& phi0);
  /// Continues from a checkpoint.
  LiquidSolver(FluidParams params, LiquidSetup setup, LiquidState state);
  ~LiquidSolver();
  LiquidSolver(LiquidSolver&&) noexcept;

  /// Advances by dt [s] in as many sub-steps as the CFL limit asks for; `pushes` act at once, in the first of
  /// them. Throws NumericalFailure, and then the state is as it was before the call.
  LiquidStepReport step(double dt, const ImmersedGas& gas = {}, const std::vector<Push>& pushes = {});

  /// Takes the last successful step back, as when another module failed in the same shared step.
  void rollBack();

  /// Largest dt [s] that one step takes in at most `maxSubSteps` sub-steps at the present velocities.
  double stableDt(int maxSubSteps = 1) const;

  /// Volume of the grid liquid now, immersed bubbles included [m^3].
  double liquidVolume() const;
  const LiquidState& state() const;
  /// Pressure in the cells of the liquid as the last sub-step left it [Pa]; 0 elsewhere and before the first.
  const DenseField<float>& pressure() const;
  const SolidBoundary& solids() const;
  const FluidParams& params() const;

  /// Markers and pockets that left since the last call.
  std::vector<EscapedMarker> takeEscaped();
  std::vector<CollapsedPocket> takeCollapsedPockets();

 private:
  std::unique_ptr<LiquidStages> internals_;
};

}  // namespace spume::fluid
