#pragma once

#include <Eigen/Core>
#include <functional>

#include "coupling/scene.h"

namespace spume::coupling {

/// Where a rigidly moving object is at one moment: x = rotation (placed - pivot) + pivot + shift.
struct Pose {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d offset{0, 0, 0};  ///< x = rotation placed + offset [m]

  Eigen::Vector3d toPlaced(const Eigen::Vector3d& x) const { return rotation.transpose() * (x - offset); }
  Eigen::Vector3d toWorld(const Eigen::Vector3d& placed) const { return rotation * placed + offset; }
};

Pose poseAt(const MotionSpec& motion, double t);

/// Velocity [m/s] of the object's material at world point x: that of the stretch of keys that ends at t.
Eigen::Vector3d velocityAt(const MotionSpec& motion, const Eigen::Vector3d& x, double t);

/// Whether any key changes the pose.
bool moves(const MotionSpec& motion);

}  // namespace spume::coupling
