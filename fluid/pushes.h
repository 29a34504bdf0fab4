#pragma once

#include <Eigen/Core>
#include <vector>

#include "fluid/dense_field.h"
#include "fluid/grid_spec.h"

namespace spume::fluid {

/// An impulse that something in the liquid gives it.
struct Push {
  Eigen::Vector3d position;  ///< [m]
  Eigen::Vector3d impulse;   ///< [N s]
  double resistance;         ///< impulse per slip, of what pushes against the liquid [kg]
};

/// What became of pushes.
struct PushReport {
  Eigen::Vector3d given = Eigen::Vector3d::Zero();     ///< impulse the faces took [N s]
  Eigen::Vector3d withheld = Eigen::Vector3d::Zero();  ///< and the rest [N s]
};

/// Adds pushes to the velocity of the liquid: each to the eight nearest faces of every direction that lie in
/// or at the liquid (`phi` < 0) and are `open`, by trilinear weights; a face carries the mass of one cell. A
/// face takes no more than what stops the slip of all that pushes it, so heavy crowds do not throw it back;
/// that, and pushes far from the liquid, is withheld.
class Pushes {
 public:
  PushReport apply(const GridSpec& grid, double density, const DenseField<float>& phi,
                   const MacField<float>& open, const std::vector<Push>& pushes, MacVelocity& velocity);

 private:
  void gather(const GridSpec& grid, const DenseField<float>& phi, const DenseField<float>& open,
              const std::vector<Push>& pushes, int axis);

  DenseField<double> impulse_, resistance_;  ///< of the faces of one direction [N s], [kg]
};

}  // namespace spume::fluid
