#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace spume::coupling {

/// Balls that new ones should not cover, by the cells of a grid: how much a ball would overlap them costs a
/// look at the few around it.
class ClearanceGrid {
 public:
  /// For balls placed with their centre between `lower` and `upper` [m]; `usual` is the radius [m] most of
  /// the balls do not exceed by much. Larger ones are looked at each time.
  ClearanceGrid(const Eigen::Vector3d& lower, const Eigen::Vector3d& upper, double usual);

  /// A ball of `radius` [m] at x, anywhere. O(1).
  void add(const Eigen::Vector3d& x, double radius);
  /// Room between a new ball at x, in the box, and the nearest other [m], < 0: how far they overlap; 0 if it
  /// overlaps none.
  double clearance(const Eigen::Vector3d& x, double radius) const;

 private:
  struct Ball {
    Eigen::Vector3d centre;
    double radius;
    std::int32_t next;  ///< in its cell, or -1
  };
  using Cell = Eigen::Vector3i;

  /// The cell of x, or the one at the border that is nearest to it.
  Cell cellOf(const Eigen::Vector3d& x) const;
  std::size_t place(const Cell& cell) const {
    return (static_cast<std::size_t>(cell.x()) * cells_.y() + cell.y()) * cells_.z() + cell.z();
  }

  Eigen::Vector3d lower_;
  double edge_;                      ///< of a cell [m]
  double largest_ = 0;               ///< radius of those in cells [m]
  Cell cells_;                       ///< how many along each axis
  std::vector<std::int32_t> first_;  ///< ball of each cell, or -1
  std::vector<Ball> ball_;
  std::vector<Ball> wide_;  ///< in no cell
};

}  // namespace spume::coupling
