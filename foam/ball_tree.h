#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "foam/lane_math.h"
#include "foam/radix_sort.h"
#include "foam/raw_buffer.h"

namespace spume::foam {

/// Balls in a tree of boxes, to find those near a ball (performance, "Foam geometry"): in space order, boxes
/// around each eight in a row, each eight boxes, and so on. The order is the input's where that is one in
/// space, as a step has it, else along Hilbert's curve. Small balls that share a box with a
/// large one are looked at wherever it reaches, which costs no more than the large one alone: eight are
/// tested at once. A class for each octave of sizes would tell them apart, but the boxes of sparse classes
/// are wide and meet each other everywhere. Memory is kept from build to build.
class BallTree {
 public:
  static constexpr std::int32_t kFan = 8;  ///< balls in a cluster, and boxes in a larger one

  struct Box {
    double low[3], high[3];  ///< [m]
  };
  /// Boxes as columns, with what they are around.
  struct Boxes {
    std::size_t count = 0;
    std::vector<double> low[3], high[3];  ///< [m]
    std::vector<std::int32_t> number;

    /// Makes room for whole clusters of boxes, and a block of lanes after them.
    void reserve(std::size_t boxes);
  };

  /// The ball at one place that may come to lie within that at another.
  struct Nesting {
    std::int32_t inner, outer;
  };

  /// A thread's memory for queries.
  struct Query {
    std::vector<std::int32_t> stack;
    std::int32_t group = -1;            ///< of clusters that was opened last
    Boxes around, open;                 ///< clusters near that group, and near the open cluster
    std::vector<std::int32_t> closest;  ///< of those, the ones that a ball may be near to
    std::size_t found = 0;
    std::vector<std::int32_t> near;  ///< what has been found, in its first `found` entries
    std::vector<Nesting> nestings;   ///< among these pairs
  };

  /// Sorts the balls at `position` [m] with `radius` [m, > 0]. Near is a distance below `reach` (r_i + r_j).
  /// O(n log n).
  void build(const std::vector<Eigen::Vector3d>& position, const std::vector<double>& radius, double reach);

  std::int32_t size() const { return static_cast<std::int32_t>(order_.size()); }
  /// Input index of each place in the tree.
  const std::vector<std::int32_t>& order() const { return order_; }
  /// Whether each ball's place is its input index.
  bool isInputOrder() const { return isInputOrder_; }
  std::int32_t clusters() const { return (size() + kFan - 1) / kFan; }

  /// Finds the clusters from this one on that balls of `cluster` may be near to; quick if one of the same
  /// eight was last. A new tree needs a new Query.
  void openCluster(std::int32_t cluster, Query& query) const;
  /// Adds to `query.near` the places after `s` of all balls near that at place `s`, ascending; its cluster
  /// must be open. Adds to `query.nestings` those of which one is within r_j - r_i + (reach - 1) (r_i + r_j)
  /// of the other.
  void findLater(std::int32_t s, Query& query) const;

 private:
  void sort(const std::vector<Eigen::Vector3d>& position, const std::vector<double>& radius);
  void boxClusters();
  void boxLevel(const Boxes& finer, Boxes& coarser) const;
  void openGroup(std::int32_t group, Query& query) const;
  std::size_t findClosest(std::int32_t s, Query& query) const;
  void noteNesting(std::int32_t s, std::int32_t t, Query& query) const;

  double reach_ = 1;
  RawBuffer<SortKey> keys_, spareKeys_;
  std::vector<std::int32_t> order_;
  bool isInputOrder_ = true;
  RawBuffer<double> x_, y_, z_, far_;  ///< centres and `reach` r [m], padded to whole clusters
  std::vector<Boxes> levels_;          ///< from the clusters' boxes up
  std::int32_t height_ = 0;            ///< levels in use
};

}  // namespace spume::foam
