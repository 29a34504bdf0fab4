#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace spume::coupling {

/// A signed distance [m] sampled at the points of a box, trilinear between them. Outside the box it is that
/// of the nearest point of the box plus the way there.
class DistanceField {
 public:
  /// `points` of spacing `voxel` [m] along each axis (at least 2), the first at `origin` [m].
  DistanceField(const Eigen::Vector3d& origin, double voxel, const Eigen::Vector3i& points);

  /// Spacing of at least `voxel` at which the box has no more points than fit into 256 MB.
  static double affordableVoxel(const Eigen::Vector3d& size, double voxel);

  const Eigen::Vector3i& points() const { return points_; }
  double voxel() const { return voxel_; }
  Eigen::Vector3d position(int i, int j, int k) const { return origin_ + voxel_ * Eigen::Vector3d(i, j, k); }

  /// A point whose distance is known.
  void setKnown(int i, int j, int k, double distance);
  /// A point of which only the side is known.
  void setSide(int i, int j, int k, bool inside);
  /// Distances of all other points from the known ones [Zhao 2005]. Call once, after all were set.
  void extend();

  double operator()(const Eigen::Vector3d& x) const;

 private:
  std::size_t index(int i, int j, int k) const {
    return (static_cast<std::size_t>(i) * points_.y() + j) * points_.z() + k;
  }
  void sweep(const Eigen::Vector3i& direction);
  float arrival(int i, int j, int k) const;

  Eigen::Vector3d origin_;
  double voxel_;
  Eigen::Vector3i points_;
  std::vector<float> value_;         // [voxels]
  std::vector<std::uint8_t> known_;  // empty after `extend`
};

}  // namespace spume::coupling
