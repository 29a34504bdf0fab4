#pragma once

#include <memory>
#include <vector>

#include "coupling/entrainment.h"
#include "coupling/scene.h"
#include "fluid/liquid_solver.h"
#include "foam/liquid_sampler.h"

namespace spume::coupling {

/// The liquid of a simulation as the shared step sees it: solved on a grid, at rest in closed form,
/// or read from an earlier run.
class LiquidPart {
 public:
  virtual ~LiquidPart() = default;

  /// Advances by dt [s]. Throws fluid::NumericalFailure; whatever it throws, the state is as it was before
  /// the call.
  virtual fluid::LiquidStepReport step(double dt, const fluid::ImmersedGas& gas,
                                       const std::vector<fluid::Push>& pushes) = 0;
  /// Takes the last successful step back.
  virtual void rollBack() = 0;
  /// Largest dt [s] of a step in at most `maxSubSteps` sub-steps.
  virtual double stableDt(int maxSubSteps) const = 0;
  /// Volume of the liquid now, immersed bubbles included [m^3].
  virtual double liquidVolume() const = 0;
  virtual const fluid::LiquidState& state() const = 0;
  virtual const fluid::SolidBoundary& solids() const = 0;
  /// At cell centres, over that of the air [Pa].
  virtual const fluid::DenseField<float>& pressure() const = 0;
  /// Markers and pockets that left since the last call.
  virtual std::vector<fluid::EscapedMarker> takeEscaped() = 0;
  virtual std::vector<fluid::CollapsedPocket> takeCollapsedPockets() = 0;
  /// Bubbles that a liquid of the past bore in the last step; one that moves now leaves them to entrainment.
  virtual std::vector<Birth> recordedBirths() const { return {}; }
  /// What the foam asks, of the state as it is now; to be used before the next step.
  virtual std::unique_ptr<foam::LiquidSampler> sampler() const = 0;
};

/// The liquid of a scene at its start: a StillLiquid where [still_pool] says so, a CachedLiquid where
/// [liquid_cache] names a run, else a fluid::LiquidSolver. Throws SceneError, FileError or
/// fluid::InvalidParameter.
std::unique_ptr<LiquidPart> makeLiquid(const Scene& scene);
/// The same from a checkpoint.
std::unique_ptr<LiquidPart> makeLiquid(const Scene& scene, fluid::LiquidState state);

}  // namespace spume::coupling
