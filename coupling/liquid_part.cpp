#include "coupling/liquid_part.h"

#include <utility>

#include "coupling/cached_liquid.h"
#include "coupling/scene_builder.h"
#include "coupling/still_liquid.h"
#include "coupling/vdb_liquid_sampler.h"

namespace spume::coupling {
namespace {

/// Liquid solved on a grid.
class MovingLiquid : public LiquidPart {
 public:
  MovingLiquid(const Scene& scene, fluid::LiquidSolver solver) : scene_(scene), solver_(std::move(solver)) {}

  fluid::LiquidStepReport step(double dt, const fluid::ImmersedGas& gas,
                               const std::vector<fluid::Push>& pushes) override {
    return solver_.step(dt, gas, pushes);
  }
  void rollBack() override { solver_.rollBack(); }
  double stableDt(int maxSubSteps) const override { return solver_.stableDt(maxSubSteps); }
  double liquidVolume() const override { return solver_.liquidVolume(); }
  const fluid::LiquidState& state() const override { return solver_.state(); }
  const fluid::SolidBoundary& solids() const override { return solver_.solids(); }
  const fluid::DenseField<float>& pressure() const override { return solver_.pressure(); }
  std::vector<fluid::EscapedMarker> takeEscaped() override { return solver_.takeEscaped(); }
  std::vector<fluid::CollapsedPocket> takeCollapsedPockets() override {
    return solver_.takeCollapsedPockets();
  }
  std::unique_ptr<foam::LiquidSampler> sampler() const override {
    return std::make_unique<VdbLiquidSampler>(solver_.state(), solver_.solids(),
                                              solidVelocity(scene_, solver_.state().time));
  }

 private:
  const Scene scene_;
  fluid::LiquidSolver solver_;
};

}  // namespace

std::unique_ptr<LiquidPart> makeLiquid(const Scene& scene) {
  if (scene.stillPool.enabled) return std::make_unique<StillLiquid>(scene);
  if (!scene.liquidCache.run.empty()) return std::make_unique<CachedLiquid>(scene);
  return std::make_unique<MovingLiquid>(
      scene, fluid::LiquidSolver(scene.liquid, buildLiquidSetup(scene), initialPhi(scene)));
}

std::unique_ptr<LiquidPart> makeLiquid(const Scene& scene, fluid::LiquidState state) {
  if (scene.stillPool.enabled) return std::make_unique<StillLiquid>(scene, state.time);
  if (!scene.liquidCache.run.empty()) return std::make_unique<CachedLiquid>(scene, state.time);
  return std::make_unique<MovingLiquid>(
      scene, fluid::LiquidSolver(scene.liquid, buildLiquidSetup(scene), std::move(state)));
}

}  // namespace spume::coupling
