#pragma once

#include <memory>

#include "coupling/liquid_part.h"
#include "coupling/scene_builder.h"
#include "foam/still_pool.h"

namespace spume::coupling {

/// What the foam asks of a pool at rest: a flat surface square to gravity between the walls and solids of a
/// scene, all in closed form. Where the scene has liquid bodies, there is liquid only in and at them (within
/// kBodyMargin), so that a vessel may stand in the dry.
class PoolSampler : public foam::LiquidSampler {
 public:
  explicit PoolSampler(const Scene& scene);

  void phi(foam::Points x, foam::Scalars out) const override;
  void gradPhi(foam::Points x, foam::Vectors out) const override;
  void velocity(foam::Points x, foam::Vectors out) const override;
  void gradPressure(foam::Points x, foam::Vectors out) const override;
  void psi(foam::Points x, foam::Scalars out) const override;
  void gradPsi(foam::Points x, foam::Vectors out) const override;
  void solidVelocity(foam::Points x, foam::Vectors out) const override;
  void solidIndex(foam::Points x, foam::Indices out) const override;

  /// How far the liquid reaches beyond the bodies [m]: their sides are walls, and a bubble's centre may come
  /// as near to a wall as it likes. Thinner than the glass of a vessel.
  static constexpr double kBodyMargin = 2e-3;

 private:
  struct Nearest {
    double distance;
    int solid;  ///< index, -1: a wall of the domain
  };
  Nearest nearest(const Eigen::Vector3d& x, double wall) const;
  double bodyPhi(const Eigen::Vector3d& x) const;

  foam::StillPool pool_;
  std::vector<SignedDistance> solids_;
  SignedDistance bodies_;  ///< empty: liquid everywhere under the surface
};

/// The liquid of a scene that does not move. Its state is sampled once for caches and pictures; a step costs
/// nothing.
class StillLiquid : public LiquidPart {
 public:
  /// At time `time` [s]. Throws SceneError.
  explicit StillLiquid(const Scene& scene, double time = 0);

  fluid::LiquidStepReport step(double dt, const fluid::ImmersedGas& gas,
                               const std::vector<fluid::Push>& pushes) override;
  void rollBack() override;
  double stableDt(int maxSubSteps) const override;
  double liquidVolume() const override { return volume_; }
  const fluid::LiquidState& state() const override { return state_; }
  const fluid::SolidBoundary& solids() const override { return solids_; }
  const fluid::DenseField<float>& pressure() const override { return pressure_; }
  std::vector<fluid::EscapedMarker> takeEscaped() override { return {}; }
  std::vector<fluid::CollapsedPocket> takeCollapsedPockets() override { return {}; }
  std::unique_ptr<foam::LiquidSampler> sampler() const override;

 private:
  void fillPressure(const Scene& scene);

  PoolSampler sampler_;
  fluid::LiquidState state_;
  fluid::DenseField<float> pressure_;  ///< [Pa], over that of the air
  fluid::SolidBoundary solids_;
  double volume_ = 0;  ///< [m^3]
  double before_ = 0;  ///< time the last step began at [s]
};

}  // namespace spume::coupling
