#include "foam/still_pool.h"

#include "foam/parallel.h"

namespace spume::foam {
namespace {

/// psi where there is no wall at all: far, yet finite, so that sums stay finite [m].
constexpr double kNoWall = 1e6;

template <typename Body>
void forEachPoint(const Points& x, const Body& body) {
  forEachIndex(static_cast<std::size_t>(x.cols()),
               [&](std::size_t i) { body(static_cast<Eigen::Index>(i)); });
}

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
  forEachPoint(x, [&](Eigen::Index i) { out[i] = x.col(i).dot(up_) - params_.surfaceHeight; });
}

void StillPool::gradPhi(Points x, Vectors out) const {
  forEachPoint(x, [&](Eigen::Index i) { out.col(i) = up_; });
}

void StillPool::velocity(Points x, Vectors out) const {
  forEachPoint(x, [&](Eigen::Index i) { out.col(i) = params_.velocity; });
}

void StillPool::gradPressure(Points x, Vectors out) const {
  const Eigen::Vector3d gradient = params_.density * params_.gravity;
  forEachPoint(x, [&](Eigen::Index i) { out.col(i) = gradient; });
}

void StillPool::psi(Points x, Scalars out) const {
  forEachPoint(x, [&](Eigen::Index i) { out[i] = nearestWall(x.col(i)).distance; });
}

void StillPool::gradPsi(Points x, Vectors out) const {
  forEachPoint(x, [&](Eigen::Index i) {
    out.col(i).setZero();
    if (const Wall wall = nearestWall(x.col(i)); wall.axis >= 0) out(wall.axis, i) = wall.sign;
  });
}

void StillPool::solidVelocity(Points x, Vectors out) const {
  forEachPoint(x, [&](Eigen::Index i) { out.col(i).setZero(); });
}

void StillPool::solidIndex(Points, Indices out) const { out.setConstant(-1); }

}  // namespace spume::foam
