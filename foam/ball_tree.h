#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "foam/lane_math.h"

namespace spume::foam {

/// Balls in a tree of boxes, to find those near a ball (performance, "Foam geometry"): sorted by size, a
/// class for each octave of radius, and within a class along a Morton curve whose cells are as large as the
/// balls, so that eight in a row lie together whatever the mix of sizes; then boxes around each eight of
/// them, each eight boxes, and so on. Memory is kept from build to build.
class BallTree {
 public:
  static constexpr std::int32_t kFan = 8;  ///< balls in a cluster, and boxes in a larger one

  /// A thread's memory for queries.
  struct Query {
    std::vector<std::int32_t> stack, clusters;
    std::vector<std::int32_t> near;  ///< what it has found
  };

  /// Sorts the balls at `position` [m] with `radius` [m, > 0]. Near is a distance below `reach` (r_i + r_j).
  /// O(n log n).
  void build(const std::vector<Eigen::Vector3d>& position, const std::vector<double>& radius, double reach);

  std::int32_t size() const { return static_cast<std::int32_t>(order_.size()); }
  /// Input index of each place in the tree.
  const std::vector<std::int32_t>& order() const { return order_; }
  std::int32_t clusters() const { return (size() + kFan - 1) / kFan; }

  /// Finds the clusters that balls of `cluster` may be near to.
  void openCluster(std::int32_t cluster, Query& query) const;
  /// Lists in `query.near` the input indices of all balls near that at place `s`, itself left out, in the
  /// order of the tree; its cluster must be open.
  void findNear(std::int32_t s, Query& query) const;

 private:
  /// Boxes of one level as columns, padded to whole blocks with boxes that meet nothing.
  struct Level {
    std::int32_t count = 0;
    std::vector<double> low[3], high[3];  ///< [m]

    void resize(std::int32_t boxes);
  };
  struct SortKey {
    std::uint64_t curve;
    std::int32_t index;
    bool operator<(const SortKey& other) const {
      return curve != other.curve ? curve < other.curve : index < other.index;
    }
  };

  void sort(const std::vector<Eigen::Vector3d>& position, const std::vector<double>& radius);
  void boxClusters();
  void boxLevel(const Level& finer, Level& coarser) const;
  std::uint32_t meets(const Level& level, std::int32_t block, const double* low, const double* high) const;

  std::vector<SortKey> keys_;
  std::vector<std::int32_t> order_;      ///< padded nowhere: as long as there are balls
  std::vector<std::int32_t> index_;      ///< order_, padded to whole clusters
  std::vector<double> x_, y_, z_, far_;  ///< centres and `reach` r [m], padded to whole clusters
  std::vector<Level> levels_;            ///< from the clusters' boxes up
  std::int32_t height_ = 0;              ///< levels in use
};

}  // namespace spume::foam
