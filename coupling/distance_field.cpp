#include "coupling/distance_field.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace spume::coupling {
namespace {

constexpr float kFar = 1e6f;             // [voxels] of points no sweep has reached yet
constexpr double kMostPoints = 1 << 26;  // 256 MB of floats
constexpr int kRounds = 2;               // of eight sweeps: a path bends once behind a solid's edge

}  // namespace

DistanceField::DistanceField(const Eigen::Vector3d& origin, double voxel, const Eigen::Vector3i& points)
    : origin_(origin),
      voxel_(voxel),
      points_(points),
      value_(points.cast<std::size_t>().prod(), kFar),
      known_(value_.size(), 0) {}

double DistanceField::affordableVoxel(const Eigen::Vector3d& size, double voxel) {
  return std::max(voxel, std::cbrt(size.prod() / kMostPoints));
}

void DistanceField::setKnown(int i, int j, int k, double distance) {
  value_[index(i, j, k)] = static_cast<float>(distance / voxel_);
  known_[index(i, j, k)] = 1;
}

void DistanceField::setSide(int i, int j, int k, bool inside) {
  value_[index(i, j, k)] = inside ? -kFar : kFar;
}

void DistanceField::extend() {
  for (int round = 0; round < kRounds; ++round)
    for (int n = 0; n < 8; ++n) sweep({n & 1 ? 1 : -1, n & 2 ? 1 : -1, n & 4 ? 1 : -1});
  known_ = {};
}

void DistanceField::sweep(const Eigen::Vector3i& direction) {
  const auto place = [&](int axis, int step) {
    return direction[axis] > 0 ? step : points_[axis] - 1 - step;
  };
  for (int a = 0; a < points_.x(); ++a)
    for (int b = 0; b < points_.y(); ++b)
      for (int c = 0; c < points_.z(); ++c) {
        const int i = place(0, a), j = place(1, b), k = place(2, c);
        float& value = value_[index(i, j, k)];
        if (known_[index(i, j, k)]) continue;
        const float distance = std::min(std::abs(value), arrival(i, j, k));
        value = std::copysign(distance, value);
      }
}

/// Distance at a point from those of its neighbours, |grad| = 1 upwind [voxels].
float DistanceField::arrival(int i, int j, int k) const {
  const auto along = [&](int axis) {
    Eigen::Vector3i low(i, j, k), high(i, j, k);
    low[axis] = std::max(low[axis] - 1, 0);
    high[axis] = std::min(high[axis] + 1, points_[axis] - 1);
    return std::min(std::abs(value_[index(low.x(), low.y(), low.z())]),
                    std::abs(value_[index(high.x(), high.y(), high.z())]));
  };
  std::array<float, 3> d{along(0), along(1), along(2)};
  std::sort(d.begin(), d.end());
  float u = d[0] + 1;
  if (u <= d[1]) return u;
  const float half = 0.5f * (d[0] + d[1]), gap = d[1] - d[0];
  u = half + 0.5f * std::sqrt(2 - gap * gap);
  if (u <= d[2]) return u;
  const float sum = d[0] + d[1] + d[2], squares = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
  return (sum + std::sqrt(std::max(sum * sum - 3 * (squares - 1), 0.0f))) / 3;
}

double DistanceField::operator()(const Eigen::Vector3d& x) const {
  const Eigen::Vector3d inVoxels = (x - origin_) / voxel_;
  const Eigen::Vector3d inside =
      inVoxels.cwiseMax(0.0).cwiseMin((points_.array() - 1).cast<double>().matrix());
  const Eigen::Vector3i low = inside.cast<int>().cwiseMin(points_ - Eigen::Vector3i::Constant(2));
  const Eigen::Vector3d t = inside - low.cast<double>();
  const float* p = &value_[index(low.x(), low.y(), low.z())];
  const std::size_t sj = points_.z(), si = sj * points_.y();
  const auto row = [&](const float* q) { return q[0] + t.z() * (q[1] - q[0]); };
  const auto plane = [&](const float* q) { return row(q) + t.y() * (row(q + sj) - row(q)); };
  const double value = plane(p) + t.x() * (plane(p + si) - plane(p));
  return voxel_ * (value + (inVoxels - inside).norm());
}

}  // namespace spume::coupling
