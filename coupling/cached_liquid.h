#pragma once

#include <memory>

#include "coupling/liquid_part.h"
#include "coupling/liquid_recording.h"

namespace spume::coupling {

/// The liquid of an earlier run, read from its caches and blended between their frames (`frame_blend`): the
/// foam can be computed again without it. It takes the steps and has the volumes of that run and bears the
/// bubbles that one bore; what bubbles do to it is what those of that run did.
class CachedLiquid : public LiquidPart {
 public:
  /// At time `time` [s]. Throws SceneError (the recorded liquid is not the scene's, or too short) or
  /// FileError.
  explicit CachedLiquid(const Scene& scene, double time = 0);

  fluid::LiquidStepReport step(double dt, const fluid::ImmersedGas& gas,
                               const std::vector<fluid::Push>& pushes) override;
  void rollBack() override;
  /// The recorded run's step at this time, whatever `maxSubSteps`.
  double stableDt(int maxSubSteps) const override;
  double liquidVolume() const override;
  const fluid::LiquidState& state() const override { return state_; }
  const fluid::SolidBoundary& solids() const override { return solids_; }
  const fluid::DenseField<float>& pressure() const override { return pressure_; }
  std::vector<fluid::EscapedMarker> takeEscaped() override { return {}; }
  std::vector<fluid::CollapsedPocket> takeCollapsedPockets() override { return {}; }
  std::vector<Birth> recordedBirths() const override;
  std::unique_ptr<foam::LiquidSampler> sampler() const override;

 private:
  using Frame = std::shared_ptr<const fluid::LiquidState>;

  void moveTo(double time);
  void loadFramesRound(double time);
  Frame frame(int index) const;
  StepReport beginning() const;
  double recordedAt(double time, double (*value)(const StepReport&)) const;

  const Scene scene_;
  const LiquidRecording recording_;
  const fluid::LiquidSetup setup_;
  fluid::LiquidState state_;
  fluid::SolidBoundary solids_;
  fluid::DenseField<float> pressure_;  ///< not cached: 0
  Frame before_, after_;
  int next_ = -1;         ///< which of the recording's frames is `after_`; -1: none is loaded
  double stepStart_ = 0;  ///< of the last step [s]
};

}  // namespace spume::coupling
