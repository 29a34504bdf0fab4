#include "foam/still_pool.h"

namespace spume::foam {
namespace {

/// psi where there is no wall at all: far, yet finite, so that sums stay finite [m].
constexpr double kNoWall = 1e6;

}  // namespace

StillPool::StillPool(const StillPoolParams& params) : params_(params) {
  up_ = params.gravity.norm() > 0 ? Eigen::Vector3d(-params.gravity.normalized()) : Eigen::Vector3d::UnitY();
}

StillPool::Wall StillPool::nearestWall(const Eigen::Vector3d& x) const {
  Wall nearest{kNoWall, -1, 0};
  for (int axis = 0; axis < 3; ++axis) {
    const Wall low{x[axis] - params_.lower[axis], axis, 1}, high{params_.upper[axis] - x[axis], axis, -1};
    if (params_.closed[2 * axis] && low.distance < nearest.distance) nearest = low;
    if (params_.closed[2 * axis + 1] && high.distance < nearest.distance) nearest = high;
  }
  return nearest;
}

void StillPool::phi(Points x, Scalars out) const {
  out = (x.transpose() * up_).array() - params_.surfaceHeight;
}

void StillPool::gradPhi(Points, Vectors out) const { out.colwise() = up_; }

void StillPool::velocity(Points, Vectors out) const { out.colwise() = params_.velocity; }

void StillPool::gradPressure(Points, Vectors out) const {
  out.colwise() = (params_.density * params_.gravity).eval();
}

void StillPool::psi(Points x, Scalars out) const {
  for (Eigen::Index i = 0; i < x.cols(); ++i) out[i] = nearestWall(x.col(i)).distance;
}

void StillPool::gradPsi(Points x, Vectors out) const {
  out.setZero();
  for (Eigen::Index i = 0; i < x.cols(); ++i)
    if (const Wall wall = nearestWall(x.col(i)); wall.axis >= 0) out(wall.axis, i) = wall.sign;
}

void StillPool::solidVelocity(Points, Vectors out) const { out.setZero(); }

void StillPool::solidIndex(Points, Indices out) const { out.setConstant(-1); }

}  // namespace spume::foam
