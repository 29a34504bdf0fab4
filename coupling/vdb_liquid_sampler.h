#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>

#include "coupling/liquid_cache.h"
#include "fluid/liquid_state.h"
#include "fluid/solid_boundary.h"
#include "foam/liquid_sampler.h"

namespace spume::coupling {

/// Velocity [m/s] of solid `object` (-1: a wall of the domain) at a world point.
using SolidVelocity = std::function<Eigen::Vector3d(int object, const Eigen::Vector3d& x)>;

/// Answers the foam's questions from the liquid's dense windows: trilinear everywhere, so exact where a field
/// is linear. phi and psi come from cell centres, their gradients are the derivatives of the interpolants;
/// velocity and grad p come from the faces. Between the outermost samples and the border of the grid the
/// interpolant is continued; outside, phi is continued along its gradient, velocity and grad p are held, and
/// psi falls by the distance to the grid. Batches run in parallel; the answer for a point does not depend on
/// its batch.
class VdbLiquidSampler : public foam::LiquidSampler {
 public:
  /// Borrows both: they must outlive the sampler. Empty `solidVelocity`: all solids rest.
  VdbLiquidSampler(const fluid::LiquidState& liquid, const fluid::SolidBoundary& solids,
                   SolidVelocity solidVelocity = {});
  /// Keeps a cached frame. A cache holds no pressure: grad p is `density` [kg/m^3] times `gravity` [m/s^2].
  VdbLiquidSampler(LiquidFrame frame, double density, const Eigen::Vector3d& gravity);
  ~VdbLiquidSampler() override;

  void phi(foam::Points x, foam::Scalars out) const override;
  void gradPhi(foam::Points x, foam::Vectors out) const override;
  void velocity(foam::Points x, foam::Vectors out) const override;
  void gradPressure(foam::Points x, foam::Vectors out) const override;
  void psi(foam::Points x, foam::Scalars out) const override;
  void gradPsi(foam::Points x, foam::Vectors out) const override;
  void solidVelocity(foam::Points x, foam::Vectors out) const override;
  void solidIndex(foam::Points x, foam::Indices out) const override;

 private:
  struct Source;
  std::unique_ptr<const Source> source_;
};

}  // namespace spume::coupling
