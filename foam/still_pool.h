#pragma once

#include <array>

#include "foam/liquid_sampler.h"

namespace spume::foam {

/// What a StillPool is.
struct StillPoolParams {
  Eigen::Vector3d gravity{0, -9.8, 0};  ///< [m/s^2]; the surface is square to it, or to y without gravity
  double density = 1000;                ///< [kg/m^3]
  double surfaceHeight = 0;             ///< of the surface above the origin, against gravity [m]
  Eigen::Vector3d velocity{0, 0, 0};    ///< of the liquid, the same everywhere [m/s]
  Eigen::Vector3d lower{-1, -1, -1};    ///< corner of the box [m]
  Eigen::Vector3d upper{1, 1, 1};       ///< opposite corner [m]
  std::array<bool, 6> closed{false, false, false, false, false, false};  ///< walls: -x +x -y +y -z +z
};

/// Liquid with a flat surface in a box, in closed form: for scenes whose liquid does not move, and for tests.
/// With a uniform velocity it is the stream seen by a bubble carried along.
class StillPool : public LiquidSampler {
 public:
  explicit StillPool(const StillPoolParams& params);

  void phi(Points x, Scalars out) const override;
  void gradPhi(Points x, Vectors out) const override;
  void velocity(Points x, Vectors out) const override;
  void gradPressure(Points x, Vectors out) const override;
  void psi(Points x, Scalars out) const override;
  void gradPsi(Points x, Vectors out) const override;
  void solidVelocity(Points x, Vectors out) const override;
  void solidIndex(Points x, Indices out) const override;

 private:
  struct Wall {
    double distance;  ///< [m], > 0 inside the box
    int axis;         ///< 0, 1, 2; -1 if no wall is closed
    double sign;      ///< of the inward normal along the axis
  };
  Wall nearestWall(const Eigen::Vector3d& x) const;

  StillPoolParams params_;
  Eigen::Vector3d up_;
};

}  // namespace spume::foam
