#pragma once

#include <memory>

#include "coupling/domain_box.h"
#include "coupling/liquid_part.h"
#include "coupling/probes.h"
#include "coupling/simulation.h"

namespace spume::coupling {

/// The modules of one scene, what changes while they run, and the stages of the step they share.
struct SharedStages {
  SharedStages(const Scene& scene, std::unique_ptr<LiquidPart> liquid);

  const Scene scene;
  const DomainBox domain;
  const std::unique_ptr<LiquidPart> liquid;
  foam::FoamSolver foam;
  const Entrainment entrainment;
  const BubbleSupply supplier;
  const Probes probes;

  SimulationState state;  ///< its `liquid` stays empty: that is in the part

  /// One step of dt [s], stage by stage. Where it throws the state is left in between.
  StepReport attempt(double dt);
  /// Takes the last attempt back, wherever it threw, to `start`, the state it began with.
  void rollBack(const SimulationState& start);

 private:
  void stepLiquid(double dt, StepReport& report);
  void bear(const Birth& birth, StepReport& report);
  void entrain(StepReport& report);
  void reportFirstBubbles(StepReport& report) const;
  void supplyBubbles(double dt, StepReport& report);
  void stepFoam(double dt, StepReport& report);
  void takeFoamEvents(foam::FoamStepReport& happened, double time, StepReport& report);
  void removeLeavers(StepReport& report);
  void book(double dt, StepReport& report);
  fluid::ImmersedGas immersedGas() const;

  bool liquidHasMoved_ = false;  ///< in the last attempt
};

}  // namespace spume::coupling
