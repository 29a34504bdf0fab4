#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "coupling/bubble_supply.h"
#include "coupling/entrainment.h"
#include "coupling/event.h"
#include "coupling/gas_ledger.h"
#include "coupling/scene.h"
#include "fluid/liquid_solver.h"
#include "foam/bubble_store.h"
#include "foam/foam_solver.h"

namespace spume::coupling {

/// A row of steps.csv.
struct StepReport {
  int step = 0;
  double time = 0, dt = 0;  ///< end of the step [s]
  int foamSubSteps = 0;     ///< steps the foam split dt into
  int halvings = 0;         ///< times dt was halved because a module failed
  fluid::LiquidStepReport liquid;
  foam::FoamStepReport foam;
  GasLedger gas;                       ///< totals since the start
  double poured = 0, drained = 0;      ///< totals since the start [m^3]
  double immersedGas = 0;              ///< [m^3]
  std::size_t births = 0, bursts = 0;  ///< in this step
  std::uint64_t sourceUnplaced = 0;    ///< bubbles of sources that found no place, since the start
  double gasInSolution = 0;            ///< where it is followed, at the pressure of the air [m^3]
  double secondsLiquid = 0, secondsEntrainment = 0, secondsSupply = 0, secondsFoam = 0;
  std::vector<Event> events;
  std::vector<double> probes;  ///< readings at the end of the step, as `probeColumns` orders them
};

/// A row of frames.csv and all its steps.
struct FrameReport {
  int frame = 0;
  double time = 0;
  std::vector<StepReport> steps;
  double seconds = 0;  ///< wall time of the frame
};

/// All that changes while a scene runs, beside the scene itself: a copy is an exact checkpoint.
struct SimulationState {
  int frame = 0, step = 0;
  double time = 0;
  fluid::LiquidState liquid;
  foam::BubbleStore bubbles;
  Reservoirs reservoirs;
  SupplyState supply;
  std::vector<fluid::Push> pushes;  ///< of the bubbles, for the liquid's next step
  GasLedger gas;
  double initialVolume = 0, poured = 0, drained = 0;        ///< [m^3]
  double foamDt = std::numeric_limits<double>::infinity();  ///< longest next step the foam asked for [s]
};

class LiquidPart;
struct SharedStages;

/// Liquid and foam of one scene, advanced together.
class Simulation {
 public:
  /// Throws InvalidParameter of either module, or SceneError.
  explicit Simulation(const Scene& scene);
  /// The same with a liquid of the caller's own in place of the scene's.
  Simulation(const Scene& scene, std::unique_ptr<LiquidPart> liquid);
  /// Continues from a checkpoint of the same scene.
  Simulation(const Scene& scene, SimulationState state);
  ~Simulation();

  /// One shared step of at most dt [s]: liquid, entrainment, foam, events, statistics. dt is halved
  /// up to 4 times before NumericalFailure is thrown. Whatever is thrown, the state is as it was before.
  StepReport step(double dt);
  /// Steps that sum exactly to the next frame's time. `onStep` is called after each.
  FrameReport advanceFrame(const std::function<void(const StepReport&)>& onStep = {});

  int frame() const;
  double time() const;
  const Scene& scene() const;
  const fluid::LiquidState& liquid() const;
  const fluid::SolidBoundary& solids() const;
  /// What the foam asks of the liquid and the solids now; to be used before the next step.
  std::unique_ptr<foam::LiquidSampler> fields() const;
  const foam::BubbleStore& bubbles() const;
  const SupplyState& supply() const;
  const foam::FoamTopology& topology() const;  ///< row k is the bubble topologyIds()[k]
  const std::vector<std::uint64_t>& topologyIds() const;
  SimulationState state() const;

 private:
  std::unique_ptr<SharedStages> stages_;
};

}  // namespace spume::coupling
