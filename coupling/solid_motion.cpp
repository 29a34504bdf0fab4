#include "coupling/solid_motion.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <numbers>

namespace spume::coupling {
namespace {

constexpr double kRadiansPerDegree = std::numbers::pi / 180;

template <typename Keys>
bool changes(const Keys& keys) {
  return std::any_of(keys.begin(), keys.end(),
                     [&](const auto& key) { return key.second != keys.front().second; });
}

}  // namespace

Pose poseAt(const MotionSpec& motion, double t) {
  Pose pose;
  const double angle = kRadiansPerDegree * motion.rotation.at(t);
  pose.rotation = Eigen::AngleAxisd(angle, motion.rotationAxis.normalized()).toRotationMatrix();
  pose.offset = motion.pivot + motion.position.at(t) - pose.rotation * motion.pivot;
  return pose;
}

Eigen::Vector3d velocityAt(const MotionSpec& motion, const Eigen::Vector3d& x, double t) {
  const double spin = kRadiansPerDegree * motion.rotation.rate(t);
  const Eigen::Vector3d arm = x - motion.pivot - motion.position.at(t);
  return motion.position.rate(t) + spin * motion.rotationAxis.normalized().cross(arm);
}

bool moves(const MotionSpec& motion) {
  return changes(motion.rotation.keys) || changes(motion.position.keys);
}

}  // namespace spume::coupling
