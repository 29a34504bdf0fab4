#pragma once

#include <Eigen/Core>

namespace spume::foam {

using Points = Eigen::Ref<const Eigen::Matrix3Xd>;   ///< 3 x n, [m]
using Scalars = Eigen::Ref<Eigen::VectorXd>;         ///< n
using Vectors = Eigen::Ref<Eigen::Matrix3Xd>;        ///< 3 x n
using Indices = Eigen::Ref<Eigen::VectorXi>;         ///< n

/// What the foam asks of the liquid and the solids around it, in batches. Implementations are const and
/// thread-safe, answer for every finite point (also outside their grids) and never throw.
class LiquidSampler {
 public:
  virtual ~LiquidSampler() = default;
  virtual void phi(Points x, Scalars out) const = 0;             ///< distance to the surface [m], < 0 in liquid
  virtual void gradPhi(Points x, Vectors out) const = 0;         ///< [-], about unit length, 0 where undefined
  virtual void velocity(Points x, Vectors out) const = 0;        ///< of the liquid [m/s]
  virtual void gradPressure(Points x, Vectors out) const = 0;    ///< [Pa/m]; at rest rho g
  virtual void psi(Points x, Scalars out) const = 0;             ///< distance to the nearest solid [m], > 0 in free space
  virtual void gradPsi(Points x, Vectors out) const = 0;         ///< [-], away from the solid, 0 where undefined
  virtual void solidVelocity(Points x, Vectors out) const = 0;   ///< of the nearest solid [m/s]
  virtual void solidIndex(Points x, Indices out) const = 0;      ///< nearest solid, -1 for a wall of the domain
};

}  // namespace spume::foam
