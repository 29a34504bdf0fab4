#pragma once

#include <Eigen/Core>

#include "foam/liquid_sampler.h"

namespace spume::foam {

/// The liquid and the solids at every bubble's centre, sampled once a step; column i belongs to bubble i.
struct Surroundings {
  Eigen::VectorXd phi;              ///< [m], < 0 in liquid
  Eigen::Matrix3Xd gradPhi;         ///< [-]
  Eigen::Matrix3Xd liquidVelocity;  ///< [m/s]
  Eigen::Matrix3Xd gradPressure;    ///< [Pa/m]
  Eigen::VectorXd psi;              ///< [m], > 0 in free space
  Eigen::Matrix3Xd gradPsi;         ///< [-]
  Eigen::Matrix3Xd solidVelocity;   ///< [m/s]
  Eigen::VectorXi solid;            ///< index of the nearest solid, -1 for a wall of the domain

  /// Samples everything at `x`. Throws NumericalFailure if the sampler answers with a number that is not
  /// finite.
  void sample(const LiquidSampler& liquid, Points x);
  /// The same of the solids alone; what is of the liquid has no meaning then.
  void sampleSolids(const LiquidSampler& liquid, Points x);
  /// The same of phi and the liquid's velocity alone; nothing else has a meaning then.
  void sampleFlow(const LiquidSampler& liquid, Points x);
};

}  // namespace spume::foam
